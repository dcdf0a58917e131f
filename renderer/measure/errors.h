// SPDX-License-Identifier: MIT
// How far a shadow image ψ is from the truth ψ*, in numbers that say what kind of error it is.
#pragma once

#include "renderer/truth/truth.h"

#include <array>
#include <cstddef>
#include <span>

namespace penumbra {

// Of the differences e = ψ − ψ* over a set of pixels. Percentiles are of |e|, by nearest rank.
struct ErrorFigures {
    double rmse = 0;         // √ mean e²
    double meanAbsolute = 0; // mean |e|
    double bias = 0;         // mean e: positive where the shadows are too dark
    double p95 = 0, p99 = 0, max = 0;
};

// What an error looks like. Each pixel's squared error is divided among the kinds:
//
// Noise is what a 5x5 median would take away. With m the median of ψ over the counted pixels of the 5x5 window around
// the pixel, e² − (m − ψ*)² is noise where that is positive. The rest is (s − ψ*)², with s = m there and else s = ψ,
// and belongs to one kind as a whole:
//   lit in truth (ψ* ≤ 0.01) and s > ψ*:  a fringe of a shadow's edge makes the penumbra too wide, else a false shadow;
//   dark in truth (ψ* ≥ 0.99) and s < ψ*: a fringe makes the penumbra too wide, else a leak;
//   else s nearer to ½ than ψ* is: too wide (a softer edge), s farther: too narrow (a harder edge).
// A pixel is of a fringe if s is on the truth's side of ½ and steps over neighbours of the same kind lead to it from
// where the truth is not lit (not dark), along which s fades without rising (falling) by more than 0.01 a step. So the
// outskirts of a blurred edge are a fringe; spots, bands and slabs of their own are leaks and false shadows.
enum class ErrorKind { Leak, FalseShadow, Noise, Wide, Narrow };
inline constexpr size_t errorKinds = 5;

struct Errors {
    ErrorFigures all, penumbra;             // over the counted pixels, and over those of them with ψ* in (0.01, 0.99)
    std::array<double, errorKinds> share{}; // of the sum of e², by kind; they sum to 1, or are 0 without any error
    size_t pixels = 0, penumbraPixels = 0;  // counted: those that face the whole light
    size_t cutByHorizon = 0;                // not counted: part of the light is below the surface's horizon
    size_t notFinite = 0;                   // of the counted pixels; if there are any, the figures mean nothing
    double shareOf(ErrorKind kind) const { return share[static_cast<size_t>(kind)]; }
};

// `shadow` is ψ, one value a pixel of the truth, row 0 at the top.
Errors errorsOf(std::span<const float> shadow, const Truth& truth);

// A frame of a sequence from a camera at rest, and its truth.
struct ShadowFrame {
    std::span<const float> shadow;
    const Truth* truth;
};
// The mean of |(ψ₂ − ψ₂*) − (ψ₁ − ψ₁*)| over pixels that are counted in both: with one truth, of |ψ₂ − ψ₁|.
double flicker(const ShadowFrame& first, const ShadowFrame& second);

} // namespace penumbra
