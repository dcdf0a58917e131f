// SPDX-License-Identifier: MIT
#include "ui/chart_scale.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

// The least of 1, 2, 5, 10, 20 ... times a power of ten that is not below `value`.
double roundStep(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= value * (1 - 1e-9)) return digit * power;
    return 10 * power;
}

constexpr double room = 1.08;    // linear: above the largest
constexpr double logRoom = 1.25; // logarithmic: around all

} // namespace

double ChartAxis::position(double value) const {
    if (!(to > from)) return 0;
    if (!logarithmic) return std::clamp((value - from) / (to - from), 0.0, 1.0);
    return value > 0 ? std::clamp(std::log(value / from) / std::log(to / from), 0.0, 1.0) : 0;
}

ChartAxis fitAxis(std::span<const double> values, bool logarithmic) {
    double least = 0, most = 0;
    for (const double value : values) {
        if (!(value > 0) || !std::isfinite(value)) continue;
        least = least > 0 ? std::min(least, value) : value;
        most = std::max(most, value);
    }
    if (!logarithmic) return {0, most > 0 ? most * room : 1, false};
    if (!(most > 0)) return {0.1, 10, true};
    ChartAxis axis{least / logRoom, most * logRoom, true};
    if (axis.to < 2 * axis.from) {
        const double middle = std::sqrt(axis.from * axis.to);
        axis.from = middle / std::sqrt(2.0);
        axis.to = middle * std::sqrt(2.0);
    }
    return axis;
}

Ticks ticksOf(const ChartAxis& axis, int room) {
    Ticks ticks;
    constexpr size_t most = 32;
    room = std::clamp(room, 2, static_cast<int>(most));
    const auto add = [&](double value) {
        const double slack = 1e-9 * (axis.to - axis.from);
        if (value >= axis.from - slack && value <= axis.to + slack && ticks.size() < most) ticks.push_back(value);
    };
    const double decades = axis.logarithmic ? std::log10(axis.to / axis.from) : 0;
    // Less than half a decade is read like a linear axis.
    if (!axis.logarithmic || decades < 0.5) {
        const double step = roundStep((axis.to - axis.from) / room);
        for (double i = std::ceil(axis.from / step - 1e-9); i * step <= axis.to * (1 + 1e-12); ++i) add(i * step + 0.0); // no −0
        return ticks;
    }
    using Digits = std::span<const double>;
    static constexpr double six[] = {1, 1.5, 2, 3, 5, 7}, three[] = {1, 2, 5}, two[] = {1, 3}, one[] = {1};
    Digits digits = one;
    for (const Digits more : {Digits(two), Digits(three), Digits(six)})
        if (static_cast<double>(more.size()) * decades <= room) digits = more;
    const int stride = std::max(1, static_cast<int>(std::ceil(decades / room)));
    const int first = static_cast<int>(std::floor(std::log10(axis.from)));
    for (int decade = first; std::pow(10.0, decade) <= axis.to; ++decade) {
        if (((decade % stride) + stride) % stride != 0) continue;
        const double power = std::pow(10.0, std::abs(decade));
        for (const double digit : digits) add(decade < 0 ? digit / power : digit * power);
    }
    return ticks;
}

} // namespace penumbra
