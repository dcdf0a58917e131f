// SPDX-License-Identifier: MIT
#include "renderer/scene/camera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace penumbra {

glm::mat4 eyeFromWorld(const Camera& camera) {
    const glm::vec3 away = camera.eye - camera.target;
    const float distance = glm::length(away);
    const glm::vec3 z = distance > 0 ? away / distance : glm::vec3(0, 0, 1);
    // An up vector along the line of sight says nothing about the roll; another axis must.
    glm::vec3 side = glm::cross(camera.up, z);
    if (glm::length(side) <= 1e-6f * glm::length(camera.up)) side = glm::cross(glm::vec3(0, 1, 0), z);
    if (glm::length(side) <= 1e-6f) side = glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(side);
    const glm::vec3 y = glm::cross(z, x);
    const glm::mat3 eyeFromWorldRotation = glm::transpose(glm::mat3(x, y, z));
    glm::mat4 result(eyeFromWorldRotation);
    result[3] = glm::vec4(-(eyeFromWorldRotation * camera.eye), 1);
    return result;
}

View makeView(const Camera& camera, glm::ivec2 size, float near, float far) {
    View view;
    view.eyeFromWorld = eyeFromWorld(camera);
    view.eyeWorld = camera.eye;
    view.near = near;
    view.far = far;
    view.size = size;
    view.tanHalfFovY = std::tan(0.5f * glm::radians(camera.fovY));

    const float aspect = float(size.x) / float(size.y);
    // Near and far change places: see View::clipFromWorld.
    view.clipFromWorld = glm::perspectiveRH_ZO(glm::radians(camera.fovY), aspect, far, near) * view.eyeFromWorld;

    // The rows of the rotation are the eye's axes in the world.
    const glm::mat3 worldFromEye = glm::transpose(glm::mat3(view.eyeFromWorld));
    const float tanHalfFovX = view.tanHalfFovY * aspect;
    view.rayCorner = worldFromEye * glm::vec3(-tanHalfFovX, -view.tanHalfFovY, -1);
    view.rayDx = worldFromEye[0] * (2 * tanHalfFovX / float(size.x));
    view.rayDy = worldFromEye[1] * (2 * view.tanHalfFovY / float(size.y));
    return view;
}

View grown(const View& view, glm::ivec2 margin) {
    if (margin == glm::ivec2(0)) return view;
    View larger = view;
    larger.size = view.size + 2 * margin;
    const glm::vec2 share = glm::vec2(view.size) / glm::vec2(larger.size);
    larger.clipFromWorld = glm::scale(glm::mat4(1), glm::vec3(share, 1)) * view.clipFromWorld;
    larger.rayCorner -= static_cast<float>(margin.x) * view.rayDx + static_cast<float>(margin.y) * view.rayDy;
    larger.eyeWorld -= static_cast<float>(margin.x) * view.eyeDx + static_cast<float>(margin.y) * view.eyeDy;
    larger.tanHalfFovY /= share.y;
    return larger;
}

} // namespace penumbra
