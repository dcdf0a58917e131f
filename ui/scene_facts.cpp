// SPDX-License-Identifier: MIT
#include "ui/scene_facts.h"

#include <algorithm>

namespace penumbra {

SceneFacts::SceneFacts(std::shared_ptr<const Scene> taken) : scene(std::move(taken)) {
    evaluatePose(*scene, 0, pose);
    boundsWorld = worldBounds(*scene, pose);
    if (const float diagonal = boundsWorld.diagonal(); diagonal > 0) size = diagonal;
    triangles = scene->triangleCount();
    if (!scene->animations.empty()) duration = scene->animations[0].duration;
}

Camera sceneCamera(const SceneFacts& facts, const NamedCamera& named) {
    Camera camera;
    camera.fovY = named.fovY;
    if (named.node < 0) return camera;
    const glm::mat4& worldFromCamera = facts.pose.worldFromNode[static_cast<size_t>(named.node)];
    camera.eye = glm::vec3(worldFromCamera[3]);
    camera.up = glm::normalize(glm::vec3(worldFromCamera[1]));
    const glm::vec3 forward = -glm::normalize(glm::vec3(worldFromCamera[2]));
    // It orbits the point of its axis nearest to the middle of the scene.
    const glm::vec3 centre = facts.boundsWorld.empty() ? glm::vec3(0) : facts.boundsWorld.centre();
    camera.target = camera.eye + forward * std::max(glm::dot(centre - camera.eye, forward), 0.05f * facts.size);
    return camera;
}

} // namespace penumbra
