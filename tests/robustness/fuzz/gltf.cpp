// SPDX-License-Identifier: MIT
// The importer under libFuzzer; scripts/fuzz builds and runs it.
#include "tests/robustness/support/hostile.h"
#include "tests/robustness/support/mutations.h"

#include <algorithm>
#include <random>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t mostBytes);

using namespace penumbra::test;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    // A folder that is not there, so that nothing it refers to can be read.
    loadHostile("/nowhere/fuzzed.gltf", {data, data + size});
    return 0;
}

namespace {

// Mutates a part in place as libFuzzer would a whole file.
template <class Part> void mutate(Part& part, size_t mostBytes) {
    const size_t size = part.size();
    part.resize(std::max(mostBytes, size));
    part.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(part.data()), size, part.size()));
}

void replaceNumber(std::string& json, std::minstd_rand& random) {
    const auto numbers = numbersOf(json);
    if (numbers.empty()) return;
    const auto [offset, length] = numbers[random() % numbers.size()];
    const auto values = awkwardValues();
    json.replace(offset, length, values[random() % values.size()]);
}

} // namespace

// Most random changes of a .glb break its lengths or its JSON, and nothing behind them is reached. So most changes here
// are made to a number or to the binary chunk, and the lengths follow.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t mostBytes, unsigned seed) {
    std::minstd_rand random(seed);
    std::optional<Glb> glb = random() % 16 == 0 ? std::nullopt : splitGlb({data, size});
    if (!glb) return LLVMFuzzerMutate(data, size, mostBytes);
    const size_t room = mostBytes - std::min(mostBytes, size + 16); // for growth, with the padding of the chunks
    switch (random() % 4) {
    case 0: mutate(glb->json, glb->json.size() + room); break;
    case 1: mutate(glb->binary, glb->binary.size() + room); break;
    default: replaceNumber(glb->json, random); break;
    }
    const std::vector<uint8_t> bytes = joinGlb(*glb);
    if (bytes.size() > mostBytes) return LLVMFuzzerMutate(data, size, mostBytes);
    std::copy(bytes.begin(), bytes.end(), data);
    return bytes.size();
}
