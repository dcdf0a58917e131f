// SPDX-License-Identifier: MIT
// The importer under AddressSanitizer and UndefinedBehaviorSanitizer, which end the program at the first fault.
#include "tests/catch.h"
#include "tests/robustness/support/hostile.h"
#include "tests/robustness/support/mutations.h"

#include <cstdio>
#include <random>

using namespace penumbra::test;
namespace fs = std::filesystem;

// No file here is larger than a few hundred kilobytes. Whoever asks for more believes a size that one of them claims.
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=100"; }
extern "C" void __sanitizer_set_death_callback(void (*callback)());

namespace {

const fs::path ours = fs::path(PENUMBRA_SOURCE_FOLDER) / "tests/robustness";
const fs::path shared = fs::path(PENUMBRA_SHARED_FOLDER) / "scenes";

std::string now; // what is being loaded, told when a sanitizer ends the program

std::string load(const fs::path& file, const std::string& as, std::vector<uint8_t> bytes) {
    static const bool told = [] {
        __sanitizer_set_death_callback([] { std::fprintf(stderr, "while loading %s\n", now.c_str()); });
        return true;
    }();
    static_cast<void>(told);
    now = file.string() + ", " + as;
    INFO(now);
    std::string message;
    REQUIRE_NOTHROW(message = loadHostile(file, std::move(bytes)));
    return message;
}

std::vector<uint8_t> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

// A .gltf of a few kilobytes with its buffers inside, and the same as .glb files might be.
struct Sound {
    fs::path file;
    std::string text;
};

std::vector<Sound> soundFiles() {
    std::vector<Sound> files;
    for (const fs::path& file : gltfFilesBelow(ours / "sound", 20'000)) {
        const std::vector<uint8_t> bytes = bytesOfFile(file);
        files.push_back({file, {bytes.begin(), bytes.end()}});
    }
    REQUIRE(files.size() >= 4);
    return files;
}

} // namespace

TEST_CASE("sound files load") {
    for (const Sound& sound : soundFiles()) CHECK(load(sound.file, "as it is", bytesOf(sound.text)).empty());
}

TEST_CASE("what was once a fault is refused or loads") {
    const std::vector<fs::path> files = gltfFilesBelow(ours / "gltf", 1'000'000);
    CHECK(!files.empty());
    for (const fs::path& file : files) load(file, "as it is", bytesOfFile(file));
}

TEST_CASE("the shared broken files are refused or load") {
    const std::vector<fs::path> files = gltfFilesBelow(shared / "bad", 1'000'000);
    if (files.empty()) WARN("left out: no shared scenes");
    for (const fs::path& file : files) load(file, "as it is", bytesOfFile(file));
}

TEST_CASE("a file that ends early is refused") {
    for (const Sound& sound : soundFiles()) {
        const size_t whole = sound.text.rfind('}');
        for (size_t length = 0; length < whole; length += 1 + whole / 300)
            CHECK(!load(sound.file, "its first " + std::to_string(length) + " bytes",
                        bytesOf(sound.text.substr(0, length)))
                       .empty());
    }
}

TEST_CASE("flipped bits are refused or load") {
    std::minstd_rand random(1);
    for (const Sound& sound : soundFiles()) {
        size_t refused = 0;
        constexpr size_t tries = 600;
        for (size_t i = 0; i < tries; ++i) {
            std::vector<uint8_t> bytes = bytesOf(sound.text);
            for (size_t flips = 1 + random() % 3; flips > 0; --flips)
                bytes[random() % bytes.size()] ^= uint8_t(1u << random() % 8);
            refused += !load(sound.file, "flipped, try " + std::to_string(i), std::move(bytes)).empty();
        }
        CHECK(refused > tries / 10);
        CHECK(refused < tries);
    }
}

TEST_CASE("awkward numbers are refused or load") {
    size_t next = 0;
    for (const Sound& sound : soundFiles())
        for (const auto& [offset, length] : numbersOf(sound.text))
            for (size_t i = 0; i < 5; ++i) { // all of them in turn
                const std::string_view value = awkwardValues()[next++ % awkwardValues().size()];
                std::string text = sound.text;
                text.replace(offset, length, value);
                load(sound.file, "the number at " + std::to_string(offset) + " as " + std::string(value),
                     bytesOf(text));
            }
}
