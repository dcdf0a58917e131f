// SPDX-License-Identifier: MIT
#include "ui/image_mapping.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

ValueRange quantileRange(const Renderer::Pixels& pixels, int channel, double low, double high,
                         std::vector<float>& scratch) {
    constexpr size_t mostSamples = 65536;
    const size_t texels = pixels.values.size() / static_cast<size_t>(std::max(pixels.channels, 1));
    // An odd step visits all columns even if the width is a power of two.
    const size_t step = std::max<size_t>(texels / mostSamples, 1) | 1;
    scratch.clear();
    for (size_t i = 0; i < texels; i += step) {
        const float value = pixels.values[i * pixels.channels + channel];
        if (std::isfinite(value)) scratch.push_back(value);
    }
    if (scratch.empty()) return {};
    const auto quantile = [&](double q) {
        const auto place = scratch.begin() + static_cast<ptrdiff_t>(q * static_cast<double>(scratch.size() - 1));
        std::nth_element(scratch.begin(), place, scratch.end());
        return *place;
    };
    const ValueRange range{quantile(low), quantile(high)};
    if (range.min < range.max) return range;
    const float around = range.min == 0 ? 1.0f : std::abs(range.min) / 2;
    return {range.min - around, range.max + around};
}

BadTexels countBadTexels(const Renderer::Pixels& pixels) {
    BadTexels count;
    for (size_t i = 0; i < pixels.values.size(); i += static_cast<size_t>(pixels.channels)) {
        bool nan = false, infinite = false;
        for (int c = 0; c < pixels.channels; ++c) {
            nan |= std::isnan(pixels.values[i + c]);
            infinite |= std::isinf(pixels.values[i + c]);
        }
        count.nan += nan;
        count.infinite += infinite;
    }
    return count;
}

void mapToRgba(const Renderer::Pixels& pixels, const ImageWindow& window, ShownChannels channels, ValueRange range,
               int width, int height, std::vector<uint8_t>& rgba) {
    rgba.resize(static_cast<size_t>(width) * height * 4);
    // Doubles: the range may span all of float.
    const double scale = 255.0 / (static_cast<double>(range.max) - range.min);
    const auto shade = [&](float value) {
        return std::isfinite(value)
                   ? static_cast<uint8_t>(std::clamp((value - double{range.min}) * scale + 0.5, 0.0, 255.0))
                   : uint8_t{0};
    };
    uint8_t* out = rgba.data();
    for (int y = 0; y < height; ++y) {
        const double texelY = window.top + (y + 0.5) / window.pixelsPerTexel;
        for (int x = 0; x < width; ++x, out += 4) {
            const double texelX = window.left + (x + 0.5) / window.pixelsPerTexel;
            if (texelX < 0 || texelY < 0 || texelX >= pixels.width || texelY >= pixels.height) {
                std::fill(out, out + 4, uint8_t{0});
                continue;
            }
            const size_t texel = static_cast<size_t>(texelY) * pixels.width + static_cast<size_t>(texelX);
            const float* values = pixels.values.data() + texel * pixels.channels;
            bool nan = false, infinite = false;
            for (int i = 0; i < 3; ++i) {
                const float value = channels[i] < 0 ? range.min : values[channels[i]];
                nan |= std::isnan(value);
                infinite |= std::isinf(value);
                out[i] = shade(value);
            }
            out[3] = 255;
            if (nan)
                out[0] = 255, out[1] = 0, out[2] = 255;
            else if (infinite)
                out[0] = 0, out[1] = 255, out[2] = 255;
        }
    }
}

} // namespace penumbra
