// SPDX-License-Identifier: MIT
// What a technique tells of one pixel, as Technique::probePlots() declares it: courses over the frames, places, and
// dots over the view.
#pragma once

#include "ui/plot.h"

#include "renderer/inspect/probe.h"

namespace penumbra {

class ProbePanel {
public:
    Probe probe;

    // Draws into the current ImGui window.
    void draw(const Session& session);
    // Where the pixel is, over the picture that a view shows at a corner.
    void overlay(const Session& session, ImVec2 corner, ImVec2 size) const;

private:
    void course(const Session& session, ImVec2 size);
    void drawCourse(const Plot& plot, const ProbePlot& course, size_t column, std::optional<float> truth) const;
    void curves(std::span<const ProbePlot> plots, ImVec2 size) const;
    void places(const ProbePlot& plot, size_t column, float side) const;
    void numbers(const Session& session, std::optional<float> truth) const;

    bool fitted_ = false;      // the lines fill the chart, else ψ from 0 to 1
    bool logarithmic_ = false; // frames
};

} // namespace penumbra
