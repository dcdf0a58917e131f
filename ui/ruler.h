// SPDX-License-Identifier: MIT
// The penumbra ruler: a line across a shadow's edge, and ψ of technique and truth along it.
#pragma once

#include "ui/light_gizmo.h"
#include "ui/widgets.h"

#include "renderer/measure/yardstick.h"

namespace penumbra {

enum class RulerGrip { None, From, To, Both };
// What of the line lies under the pointer, within `reach` units of it.
RulerGrip gripAt(const RulerLine& line, const ScreenView& screen, glm::vec2 pointer, float reach);
// Both ends stay in the picture.
void dragRuler(RulerLine& line, RulerGrip grip, const ScreenView& screen, glm::vec2 delta);
void drawRuler(const RulerLine& line, const ScreenView& screen, RulerGrip lit);

// The plot and the widths.
class RulerPlot {
public:
    // Draws into the current ImGui window, as wide as it is. `low`: where there is little room.
    void draw(const RulerLine& line, const Yardstick& yardstick, bool low);
    static float height(const Yardstick& yardstick, bool low); // that draw() needs

private:
    std::array<std::vector<float>, 3> profiles_; // of A, B and the truth; empty: there is none
};

} // namespace penumbra
