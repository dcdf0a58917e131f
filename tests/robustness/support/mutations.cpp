// SPDX-License-Identifier: MIT
#include "tests/robustness/support/mutations.h"

#include <cstring>

namespace penumbra::test {
namespace {

constexpr uint32_t glbMagic = 0x46546C67, jsonChunk = 0x4E4F534A, binChunk = 0x004E4942;

uint32_t wordAt(std::span<const uint8_t> bytes, size_t offset) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

} // namespace

std::optional<Glb> splitGlb(std::span<const uint8_t> bytes) {
    if (bytes.size() < 20 || wordAt(bytes, 0) != glbMagic || wordAt(bytes, 16) != jsonChunk) return std::nullopt;
    const size_t jsonLength = wordAt(bytes, 12);
    if (jsonLength > bytes.size() - 20) return std::nullopt;
    Glb glb{std::string(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(jsonLength)), {}};
    bytes = bytes.subspan(20 + jsonLength);
    if (bytes.empty()) return glb;
    if (bytes.size() < 8 || wordAt(bytes, 4) != binChunk || wordAt(bytes, 0) > bytes.size() - 8) return std::nullopt;
    bytes = bytes.subspan(8, wordAt(bytes, 0));
    glb.binary.assign(bytes.begin(), bytes.end());
    return glb;
}

std::vector<uint8_t> joinGlb(const Glb& glb) {
    const auto padded = [](size_t size) { return (size + 3) / 4 * 4; };
    const size_t length = 12 + 8 + padded(glb.json.size()) + 8 + padded(glb.binary.size());
    std::vector<uint8_t> bytes;
    bytes.reserve(length);
    const auto add = [&](size_t word) {
        for (int shift = 0; shift < 32; shift += 8) bytes.push_back(uint8_t(word >> shift));
    };
    const auto addChunk = [&](uint32_t type, const auto& data, uint8_t padding) {
        add(padded(data.size()));
        add(type);
        bytes.insert(bytes.end(), data.begin(), data.end());
        bytes.resize(bytes.size() + padded(data.size()) - data.size(), padding);
    };
    add(glbMagic);
    add(2);
    add(length);
    addChunk(jsonChunk, glb.json, ' ');
    addChunk(binChunk, glb.binary, 0);
    return bytes;
}

std::vector<std::pair<size_t, size_t>> numbersOf(std::string_view json) {
    std::vector<std::pair<size_t, size_t>> numbers;
    for (size_t i = 0; i < json.size(); ++i) {
        if (json[i] == '"') {
            for (++i; i < json.size() && json[i] != '"'; ++i)
                if (json[i] == '\\') ++i;
        } else if (json[i] == '-' || (json[i] >= '0' && json[i] <= '9')) {
            const size_t end = std::min(json.find_first_not_of("+-.0123456789Ee", i), json.size());
            numbers.emplace_back(i, end - i);
            i = end - 1;
        }
    }
    return numbers;
}

std::span<const std::string_view> awkwardValues() {
    static constexpr std::string_view values[] = {
        "-1",         "0",          "1",      "2",    "3",    "4",     "7",     "16",          "255",
        "256",        "65535",      "65536",  "1e9",  "0.5",  "1e39",  "-1e38", "1e308",       "9007199254740993",
        "2147483647", "2147483648", "-32768", "5120", "5121", "5123",  "5125",  "5126",        "18446744073709551615",
        "4294967295", "4294967296", "1e-45",  "null", "true", "\"x\"", "[]",    "{\"a\":[1]}", "[0,1,2]"};
    return values;
}

} // namespace penumbra::test
