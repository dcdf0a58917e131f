// SPDX-License-Identifier: MIT
// How long a technique drags a ghost behind: something happens to the view, and the error goes from there frame by
// frame.
#pragma once

#include "ui/plot.h"

#include "renderer/measure/background_measurement.h"

#include <optional>
#include <string>
#include <vector>

namespace penumbra {

class MotionPanel {
public:
    MotionPanel(SideContext::MakeCurrent makeCurrent, TruthCache* cache)
        : measurement_(std::move(makeCurrent))
        , cache_(cache) {}

    // Draws into the current ImGui window. `busy`: something else is measured, which this would disturb.
    void draw(const Session& session, bool busy);
    // Takes in what was measured meanwhile; call it every frame, whether the panel is drawn or not. A line to say, or
    // nothing.
    std::string poll();
    bool measuring() const { return measurement_.progress() != nullptr; }

private:
    enum class Error { Penumbra, All };
    struct Course { // of a setting
        std::string name, values;
        std::vector<double> all, penumbra; // RMSE, one a frame, from the first frame of the rest on
        std::optional<double> flicker;
    };

    void begin(const Session& session);
    const std::vector<double>& errorsOf(const Course& course) const {
        return error_ == Error::All ? course.all : course.penumbra;
    }
    void chart(ImVec2 size) const;
    void controls(const Session& session, bool busy);
    void progress();
    void numbers() const;

    BackgroundMeasurement measurement_;
    TruthCache* cache_;
    int event_ = static_cast<int>(MotionEvent::CameraPan);
    int frames_ = 32; // from the event on
    Error error_ = Error::Penumbra;
    std::vector<Course> courses_;
    std::string measured_; // what was, in a line
};

} // namespace penumbra
