// SPDX-License-Identifier: MIT
// Loads a file as its worst enemy would have it loaded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::test {

// Imports the bytes of a .gltf or .glb and uses what comes of it. Gives the message if they are refused, else nothing.
// Throws std::logic_error if that message is no line or if the scene breaks a promise; whatever else goes wrong is for
// the sanitizers to notice.
std::string loadHostile(const std::filesystem::path& file, std::vector<uint8_t> bytes);

std::vector<uint8_t> bytesOfFile(const std::filesystem::path& file);

// Those .gltf and .glb below the folder of at most `mostBytes`, in alphabetical order; none if there is no such folder.
std::vector<std::filesystem::path> gltfFilesBelow(const std::filesystem::path& folder, uintmax_t mostBytes);

} // namespace penumbra::test
