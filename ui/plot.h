// SPDX-License-Identifier: MIT
// The paper of a chart: two axes with their ticks and titles. Who has it draws on it.
#pragma once

#include "ui/chart_scale.h"
#include "ui/widgets.h"

namespace penumbra {

struct Plot {
    ImVec2 corner, size;
    ChartAxis across, up;
    std::string_view acrossTitle, upTitle;

    // The corners of what the axes enclose, lower left and upper right.
    ImVec2 low() const;
    ImVec2 high() const;
    bool drawable() const; // there is room for anything at all
    ImVec2 at(double x, double y) const;
    void drawPaper() const;
    void drawAxes() const;
};

ShortText tickText(double value);
ImU32 faded(ImVec4 colour, float opacity);
float widthOf(std::string_view line);

// Of the i-th of several lines that belong together.
ImVec4 lineColour(size_t i);

} // namespace penumbra
