// SPDX-License-Identifier: MIT
#include "ui/scene_facts.h"

#include <algorithm>

namespace penumbra {

SceneFacts::SceneFacts(std::shared_ptr<const Scene> taken) : scene(std::move(taken)) {
    evaluatePose(*scene, 0, 0, pose);
    boundsWorld = worldBounds(*scene, pose);
    if (const float diagonal = boundsWorld.diagonal(); diagonal > 0) size = diagonal;
    triangles = scene->triangleCount();
}

} // namespace penumbra
