// SPDX-License-Identifier: MIT
// The technique beside the truth or beside technique B: how it is chosen, and what stands on the picture then.
#pragma once

#include "ui/keys.h"
#include "ui/ruler.h"

namespace penumbra {

class ComparePanel {
public:
    // What the keys say of it.
    void strokes(const Keys& keys, Session& session, Yardstick& yardstick, ViewSettings& view);
    // A button with everything to choose.
    void button(Session& session, Yardstick& yardstick, ViewSettings& view);
    // Labels, colours and numbers over the view, in the current ImGui window. `costs` of the technique and of technique
    // B [ms]; 0: not known.
    void overlay(const Session& session, Yardstick& yardstick, const ViewSettings& view, ImVec2 corner, ImVec2 size,
                 std::array<double, 2> costs);

private:
    void compare(Session& session, Yardstick& yardstick, Against against);
    void wantTruth(Session& session, Yardstick& yardstick, bool wanted);
    void popup(Session& session, Yardstick& yardstick, ViewSettings& view);
    void numbers(const Session& session, Yardstick& yardstick, std::array<double, 2> costs, bool folded);
    void truthLine(const Session& session, Yardstick& yardstick);

    Against last_ = Against::Truth; // that was compared with
    std::optional<bool> folded_;    // the numbers, to one line; not chosen yet: in a small view
    RulerPlot plot_;
};

} // namespace penumbra
