// SPDX-License-Identifier: MIT
// Pictures on disk. The ending of the file decides: .png has 8 bits a channel, .exr, .pfm and .npy keep the floats.
#pragma once

#include "app/json_text.h"
#include "renderer/core/picture.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

enum class PictureFormat { Png, Exr, Pfm, Npy };

// By the ending. Throws InputError that lists the endings.
PictureFormat pictureFormat(const std::filesystem::path& file);

// .png: values are [0, 1] as they are to be stored (sRGB encoded); 1, 3 or 4 channels (grey, RGB, RGBA). .exr: 32-bit
// floats under their names. .pfm: 1 or 3 channels. .npy: float32 of shape (height, width) or (height, width, channels).
// `facts`, an object or nothing, is told about the picture in the file itself: of a .png in the text chunk "penumbra",
// of an .exr in string attributes "penumbra.KEY", as JSON. The other formats have no place for it. Throws InputError.
void writePicture(const std::filesystem::path& file, const Picture& picture, const Json& facts = nullptr);

// The facts of a .png or .exr, null if it holds none. The pixels are not looked at. Throws InputError.
Json readPictureFacts(const std::filesystem::path& file);

} // namespace penumbra
