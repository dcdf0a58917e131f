// SPDX-License-Identifier: MIT
#include "tests/robustness/support/hostile.h"

#include "renderer/core/error.h"
#include "renderer/scene/scene.h"
#include "tests/scene/promises.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace penumbra::test {

std::string loadHostile(const std::filesystem::path& file, std::vector<uint8_t> bytes) {
    try {
        checkPromises(importGltf(file, std::move(bytes)));
        return {};
    } catch (const InputError& error) {
        const std::string message = error.what();
        ensure(message.find('\n') == std::string::npos, "a refusal is one line");
        ensure(message.starts_with(file.string() + ": "), "a refusal begins with the file");
        return message;
    }
}

std::vector<uint8_t> bytesOfFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    ensure(bool(stream), "the file can be read");
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::filesystem::path> gltfFilesBelow(const std::filesystem::path& folder, uintmax_t mostBytes) {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::exists(folder)) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::filesystem::path extension = entry.path().extension();
        if ((extension == ".gltf" || extension == ".glb") && entry.file_size() <= mostBytes)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace penumbra::test
