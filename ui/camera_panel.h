// SPDX-License-Identifier: MIT
// Where the view is taken from: numbers, the scene's cameras, the speed of flight.
#pragma once

#include "ui/navigation.h"
#include "ui/scene_facts.h"

namespace penumbra {

class CameraPanel {
public:
    // Draws into the current ImGui window.
    void draw(Session& session, const SceneFacts& facts, ViewSettings& settings);
    // Takes the scene's next camera, the first after the last; says which.
    std::string next(Session& session, const SceneFacts& facts);

private:
    void choose(Session& session, const SceneFacts& facts, size_t index);

    // The scene's camera that was taken last and what it was, to be named as long as it stands so.
    size_t chosen_ = 0;
    Camera taken_;
};

} // namespace penumbra
