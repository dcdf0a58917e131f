// SPDX-License-Identifier: MIT
// How the numbers of an image become something to look at.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace penumbra {

// The values at the two ends of the colours.
struct ValueRange {
    float min = 0, max = 1;
    bool operator==(const ValueRange&) const = default;
};

// In the order of shaders/inspect/paint.glsl. Three channels shown together are red, green and blue whatever the map.
enum class ColourMap : uint8_t { Grey, Viridis, Diverging, Flags };
inline constexpr std::string_view colourMapNames[] = {"grey", "viridis", "diverging", "flags"};
inline constexpr std::string_view colourMapHelp[] = {
    "Black to white", "Dark blue to yellow, even in lightness",
    "Blue below zero, white at zero, red above; both sides have the scale of the farther end of the range",
    "A colour of its own for every whole number; zero is nearly black. The range does not matter"};

// What a texel can be besides a number to look at; painted over the colours. The order of shaders/inspect/source.glsl.
enum class Mark : uint8_t { NaN, Infinite, Negative, OutOfRange };
using Marks = uint8_t; // sum of 1 << mark
constexpr Marks bit(Mark mark) { return static_cast<Marks>(1 << static_cast<int>(mark)); }
constexpr Marks badNumbers = bit(Mark::NaN) | bit(Mark::Infinite);

// As shaders/inspect/paint.glsl paints them, sRGB encoded.
inline constexpr std::array<std::array<float, 3>, 4> markColours{
    {{1, 0, 1}, {0, 1, 1}, {0.25f, 0.5f, 1}, {1, 0.45f, 0}}};

struct Look {
    int channel = 0; // −1: the first three together, as red, green and blue
    ValueRange range;
    ColourMap map = ColourMap::Grey;
    Marks marks = badNumbers;
    bool operator==(const Look&) const = default;
};

// Which part of an image is seen: the texel, from the upper left corner, at the view's upper left corner.
struct ImageWindow {
    double left = 0, top = 0, texelsPerPixel = 1;
    bool operator==(const ImageWindow&) const = default;
};

} // namespace penumbra
