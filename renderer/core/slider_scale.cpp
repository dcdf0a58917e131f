// SPDX-License-Identifier: MIT
#include "renderer/core/slider_scale.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr double zeroStop = 0.1;

// The smallest positive value of a logarithmic range, or 0 if the range is shown linearly.
double logarithmicStart(const Spec& spec) {
    if (spec.scale != Scale::Logarithmic) return 0;
    const double start = spec.min > 0 ? spec.min : spec.smallest;
    return spec.min >= 0 && start > 0 && start < spec.max ? start : 0;
}

} // namespace

double sliderPosition(const Spec& spec, double value) {
    if (spec.max <= spec.min) return 0;
    const double start = logarithmicStart(spec);
    if (start == 0) return std::clamp((value - spec.min) / (spec.max - spec.min), 0.0, 1.0);
    const double stop = spec.min > 0 ? 0 : zeroStop;
    if (value <= 0) return 0;
    const double fraction = std::clamp(std::log(value / start) / std::log(spec.max / start), 0.0, 1.0);
    return stop + (1 - stop) * fraction;
}

double sliderValue(const Spec& spec, double position) {
    position = std::clamp(position, 0.0, 1.0);
    const double start = logarithmicStart(spec);
    if (start == 0) return spec.min + position * (spec.max - spec.min);
    const double stop = spec.min > 0 ? 0 : zeroStop;
    if (position < stop / 2) return 0;
    const double fraction = std::max(position - stop, 0.0) / (1 - stop);
    return std::clamp(start * std::pow(spec.max / start, fraction), start, spec.max);
}

double roundForHand(const Spec& spec, double value) {
    if (value == 0 || spec.max <= spec.min) return value;
    const double digit = logarithmicStart(spec) > 0 ? std::floor(std::log10(std::abs(value))) - 2
                                                    : std::floor(std::log10((spec.max - spec.min) / 500));
    // Multiplying by a whole power of ten keeps 0.3 as 0.3; dividing by 0.1 three times would not.
    const double power = std::pow(10.0, std::abs(digit));
    return digit < 0 ? std::round(value * power) / power : std::round(value / power) * power;
}

} // namespace penumbra
