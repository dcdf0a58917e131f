// SPDX-License-Identifier: MIT
// Pictures on disk. The ending of the file decides: .png has 8 bits a channel, .exr, .pfm and .npy keep the floats.
#pragma once

#include "renderer/core/picture.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace penumbra {

// What is told about a picture in the file itself, as (key, text); keys are short ASCII words.
using Facts = std::vector<std::pair<std::string, std::string>>;

enum class PictureFormat { Png, Exr, Pfm, Npy };

// By the ending. Throws InputError that lists the endings.
PictureFormat pictureFormat(const std::filesystem::path& file);

// .png: values are [0, 1] as they are to be stored (sRGB encoded); 1, 3 or 4 channels (grey, RGB, RGBA); facts are text
// chunks. .exr: 32-bit floats under their names; facts are string attributes. .pfm: 1 or 3 channels. .npy: float32 of
// shape (height, width) or (height, width, channels). Throws InputError.
void writePicture(const std::filesystem::path& file, const Picture& picture, const Facts& facts = {});

} // namespace penumbra
