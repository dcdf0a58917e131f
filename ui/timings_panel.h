// SPDX-License-Identifier: MIT
// What each pass costs in milliseconds and each image in bytes.
#pragma once

#include "ui/widgets.h"

#include "renderer/renderer.h"

#include <array>
#include <vector>

namespace penumbra {

// The median of the last values, so that a number can be read while it flickers.
class MedianWindow {
public:
    void add(double value);
    double median() const; // 0 if there was no value

private:
    static constexpr size_t length = 60; // frames
    std::array<double, length> values_{};
    size_t count_ = 0, next_ = 0;
};

class TimingsPanel {
public:
    // Takes note of a frame just rendered.
    void add(const FlowRunner& runner);
    void forget();
    double frameMedian() const { return frame_.median(); }

    // Draws into the current ImGui window. `approximate`: the times are timer queries of a software renderer.
    void draw(const Renderer& renderer, bool approximate) const;

private:
    struct Row {
        Stage stage;
        int label;
        MedianWindow milliseconds;
        bool seen;
    };
    void passTable(const Flow& flow) const;

    std::vector<Row> rows_; // in pass order
    MedianWindow frame_;
};

void imageTable(const Flow& flow);

} // namespace penumbra
