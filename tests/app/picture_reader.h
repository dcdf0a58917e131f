// SPDX-License-Identifier: MIT
// Reads back what app/image_file writes, independently of it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace penumbra::test {

struct ReadPicture {
    int width = 0, height = 0;
    std::vector<std::string> channels;        // as the file names them; empty names where it has none
    std::vector<float> values;                // top row first; of a PNG, 0 to 255
    std::map<std::string, std::string> facts; // text chunks or string attributes by name
};

ReadPicture readPng(const std::filesystem::path& file);
ReadPicture readExr(const std::filesystem::path& file);
ReadPicture readPfm(const std::filesystem::path& file);
ReadPicture readNpy(const std::filesystem::path& file);

} // namespace penumbra::test
