// SPDX-License-Identifier: MIT
// How the numbers of an image become something to look at.
#pragma once

#include "renderer/renderer.h"

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra {

// The values shown as black and as white.
struct ValueRange {
    float min = 0, max = 1;
    bool operator==(const ValueRange&) const = default;
};

// From the `low` to the `high` quantile of the finite values of a channel, taken from at most 65536 texels spread over
// the image. Never empty: a constant image gets a range around its value. `scratch` is reused between calls.
ValueRange quantileRange(const Renderer::Pixels& pixels, int channel, double low, double high,
                         std::vector<float>& scratch);

struct BadTexels {
    int64_t nan = 0, infinite = 0; // texels with such a value in at least one channel
};
BadTexels countBadTexels(const Renderer::Pixels& pixels);

// Which part of the image is seen: the texel coordinates (from the upper left corner) of the view's upper left corner,
// and the view's pixels per texel.
struct ImageWindow {
    double left = 0, top = 0, pixelsPerTexel = 1;
    bool operator==(const ImageWindow&) const = default;
};

// Channels shown as red, green and blue; three times the same one is grey. −1: black.
using ShownChannels = std::array<int, 3>;

// Fills width·height RGBA8 pixels, upper row first, with the nearest texels: NaN magenta, infinite cyan, outside of the
// image transparent.
void mapToRgba(const Renderer::Pixels& pixels, const ImageWindow& window, ShownChannels channels, ValueRange range,
               int width, int height, std::vector<uint8_t>& rgba);

} // namespace penumbra
