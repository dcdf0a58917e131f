// SPDX-License-Identifier: MIT
// Where on a slider a value stands, and which value a position means.
#pragma once

#include "renderer/core/parameters.h"

namespace penumbra {

// Both map between the range of `spec` and [0, 1]. A logarithmic range that starts at 0 keeps the lowest tenth of
// the slider for 0 itself and shares the rest between `spec.smallest` and `spec.max`.
double sliderPosition(const Spec& spec, double value);
double sliderValue(const Spec& spec, double position);

// `value` with as many digits as a hand on a slider can mean: linear, the nearest multiple of a power of ten near a
// thousandth of the range; logarithmic, three digits.
double roundForHand(const Spec& spec, double value);

} // namespace penumbra
