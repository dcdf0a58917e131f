// SPDX-License-Identifier: MIT
// An axis of a chart: which part of it a value is at, and where its ticks are.
#pragma once

#include "renderer/core/fixed_vector.h"

#include <span>

namespace penumbra {

struct ChartAxis {
    double from = 0, to = 1;
    bool logarithmic = false;

    double position(double value) const; // in [0, 1]: values beyond the ends are at them
    bool operator==(const ChartAxis&) const = default;
};

// Holds all values above 0 with some room around them: linear from 0 on, logarithmic over a factor of two at least. Of
// no values: 0 to 1, or 0.1 to 10.
ChartAxis fitAxis(std::span<const double> values, bool logarithmic);

// At multiples of 1, 2 or 5 times a power of ten; logarithmic at 1, 1.5, 2, 3, 5 and 7, at 1, 2 and 5, at 1 and 3 or at 1
// of each decade. `room` is about how many labels fit.
using Ticks = FixedVector<double, 32>;
Ticks ticksOf(const ChartAxis& axis, int room);

} // namespace penumbra
