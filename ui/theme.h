// SPDX-License-Identifier: MIT
// How the window looks: dark slate, one warm accent, one font with the signs of mathematics.
#pragma once

#include <imgui.h>

namespace penumbra {

namespace colour {
inline const ImVec4 text{0.87f, 0.87f, 0.88f, 1};
inline const ImVec4 muted{0.58f, 0.60f, 0.64f, 1};
inline const ImVec4 accent{0.89f, 0.70f, 0.42f, 1}; // changed values, what is chosen
inline const ImVec4 warning{0.95f, 0.62f, 0.34f, 1};
inline const ImVec4 error{0.95f, 0.45f, 0.42f, 1};
} // namespace colour

// Colours, roundings and spacing at `scale` times their size at 96 dots per inch.
void applyTheme(float scale);

// Loads DejaVu Sans at this height in pixels, or ImGui's own font (which has no Greek) where it is not installed; says
// which.
bool loadFont(float pixels);

} // namespace penumbra
