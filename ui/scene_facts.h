// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/session.h"

namespace penumbra {

// What the panels say and need to know about a scene, computed once when it is taken.
struct SceneFacts {
    std::shared_ptr<const Scene> scene;
    Pose pose; // at time 0
    Bounds boundsWorld;
    float size = 1; // diagonal of the bounds [m], never 0
    uint64_t triangles = 0;

    explicit SceneFacts(std::shared_ptr<const Scene> scene);
};

} // namespace penumbra
