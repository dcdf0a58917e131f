// SPDX-License-Identifier: MIT
// The area light that is studied: shape, size, place, direction, strength; the scene's own lights; and those that shine
// beside it.
#pragma once

#include "ui/navigation.h"
#include "ui/scene_facts.h"

namespace penumbra {

class LightPanel {
public:
    // Draws into the current ImGui window.
    void draw(Session& session, const SceneFacts& facts, ViewSettings& settings);
    // Takes the scene's next light, the first after the last; says which.
    std::string next(Session& session, const SceneFacts& facts);

private:
    void choose(Session& session, const SceneFacts& facts, size_t index);
    void ofScene(Session& session, const SceneFacts& facts);
    void furtherLights(Session& session, const SceneFacts& facts);
    static AreaLight another(const Session& session, const SceneFacts& facts);
    void shapeAndSize(AreaLight& light);
    void direction(AreaLight& light, float sceneSize);

    // The scene's light that was taken last and what it was, to be named as long as it stands so.
    size_t chosen_ = 0;
    AreaLight taken_;
};

} // namespace penumbra
