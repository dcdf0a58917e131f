// SPDX-License-Identifier: MIT
// What each pass costs in milliseconds and each image in bytes.
#pragma once

#include "ui/widgets.h"

#include "renderer/renderer.h"

#include <array>
#include <span>
#include <vector>

namespace penumbra {

// The last values of a number that is measured once a frame.
class Recent {
public:
    static constexpr size_t length = 120; // frames

    void add(double value);
    size_t count() const { return count_; }
    double ago(size_t frames) const; // 0: the newest
    // Of the newest `last` values: the one below which this fraction of them lies, between two values in proportion.
    // ½ is the median. 0 if there is no value.
    double quantile(double fraction, size_t last = length) const;

private:
    std::array<double, length> values_{};
    size_t count_ = 0, next_ = 0;
};

// What an instance of a frame costs (see below) [ms], passes included that it shares with another one.
double costOf(const TimedFrame& timed, const Flow& flow, std::string_view instance);

class TimingsPanel {
public:
    // Takes note of the newest timed frame, if it is another one, when frame number `rendered` has just been rendered.
    // `work` is what decides how much there is to do: the numbers are of frames that had the same, the graph goes on.
    void add(const TimedFrame& timed, uint64_t rendered, std::span<const uint32_t> work);
    void forget();
    // Medians [ms], 0 where nothing was measured yet. The cost of a technique is all that a picture without shadows
    // would not need: ShadowMap + Prefilter + Resolve.
    double frameMedian() const { return frame_.quantile(0.5, frames_); }
    double costMedian() const { return cost_.quantile(0.5, frames_); }

    // Draws into the current ImGui window; true: the table is to be written as CSV. `approximate`: the times are timer
    // queries of a software renderer.
    bool draw(const Renderer& renderer, bool approximate) const;

    // The numbers of the panel as a table of their own, one row for frame, cost, stage, pass or image. `method` says
    // how they were measured.
    std::string csv(const Flow& flow, std::string_view technique, std::string_view driver,
                    std::string_view method) const;

private:
    static constexpr size_t stageCount = static_cast<size_t>(Stage::Display) + 1;
    struct Row {
        Stage stage;
        int label;
        Recent milliseconds;
        bool seen;
    };
    bool holds(Stage stage) const;
    void passTable(const Flow& flow) const;
    void graph(ImVec2 size) const;

    std::vector<Row> rows_; // in pass order
    std::array<Recent, stageCount> stages_;
    Recent frame_, cost_;
    std::vector<uint32_t> work_;
    size_t frames_ = 0;       // measured with this work, at most Recent::length
    uint64_t firstFrame_ = 0; // of the timer, with this work
    uint64_t lastFrame_ = 0;  // of the timer, that was taken note of
};

} // namespace penumbra
