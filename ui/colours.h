// SPDX-License-Identifier: MIT
// The colour maps of shaders/lib/colour_map.glsl for what the panels draw themselves.
#pragma once

#include <imgui.h>

namespace penumbra {

ImU32 divergingColour(float t); // blue at −1, white at 0, red at 1
ImU32 flagColour(int number);

} // namespace penumbra
