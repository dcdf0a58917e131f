// SPDX-License-Identifier: MIT
#include "assets/make_scenes/picture.h"

#include "renderer/core/error.h"

#include <png.h>

#include <cmath>

namespace make_scenes {
namespace {

std::vector<uint8_t> encoded(unsigned size, const std::vector<uint8_t>& texels) {
    std::vector<uint8_t> bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    penumbra::ensure(info != nullptr, "libpng cannot start");
    png_set_write_fn(
        png, &bytes,
        [](png_structp p, png_bytep data, size_t length) {
            auto& out = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(p));
            out.insert(out.end(), data, data + length);
        },
        nullptr);
    png_set_compression_level(png, 0);
    png_set_filter(png, 0, PNG_FILTER_NONE);
    png_set_IHDR(png, info, size, size, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (unsigned y = 0; y < size; ++y) png_write_row(png, &texels[size_t{4} * size * y]);
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

} // namespace

std::vector<uint8_t> picture(unsigned size, const std::function<glm::dvec4(double, double)>& colour) {
    std::vector<uint8_t> texels;
    for (unsigned y = 0; y < size; ++y)
        for (unsigned x = 0; x < size; ++x) {
            glm::dvec4 sum(0);
            for (int k = 0; k < 16; ++k) sum += colour((x + (k % 4 + 0.5) / 4) / size, (y + (k / 4 + 0.5) / 4) / size);
            for (int c = 0; c < 4; ++c) {
                // A grid far coarser than a mathematics library's last bits, before what could fall to either side.
                const double value = std::round(sum[c] / 16 * 255 * 1024) / 1024;
                texels.push_back(uint8_t(std::floor(value + 0.5)));
            }
        }
    return encoded(size, texels);
}

} // namespace make_scenes
