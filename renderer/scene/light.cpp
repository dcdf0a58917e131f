// SPDX-License-Identifier: MIT
#include "renderer/scene/light.h"

#include <glm/gtc/constants.hpp>

#include <array>
#include <cmath>

namespace penumbra {
namespace {

// Concentric map of [-1, 1]² to the unit disk (Shirley and Chiu, A Low Distortion Map Between Disk and Square, 1997).
glm::vec2 concentricDisk(glm::vec2 square) {
    if (square.x == 0 && square.y == 0) return {0, 0};
    const float quarter = glm::quarter_pi<float>();
    if (std::abs(square.x) > std::abs(square.y)) {
        const float angle = quarter * square.y / square.x;
        return square.x * glm::vec2(std::cos(angle), std::sin(angle));
    }
    const float angle = quarter * square.x / square.y;
    return square.y * glm::vec2(std::sin(angle), std::cos(angle));
}

} // namespace

std::span<const std::string_view> lightShapeNames() {
    static constexpr std::array<std::string_view, 3> names{"rectangle", "disk", "directional"};
    return names;
}

glm::mat4 lightFromWorld(const AreaLight& light) {
    const glm::vec3 away = light.position - light.target;
    const float distance = glm::length(away);
    const glm::vec3 z = distance > 0 ? away / distance : glm::vec3(0, 1, 0);
    const float horizontal = std::hypot(z.x, z.z);
    const glm::vec3 x = horizontal > 1e-6f ? glm::vec3(z.z, 0, -z.x) / horizontal : glm::vec3(1, 0, 0);
    const glm::vec3 y = glm::cross(z, x);
    const glm::mat3 lightFromWorldRotation = glm::transpose(glm::mat3(x, y, z));
    glm::mat4 result(lightFromWorldRotation);
    result[3] = glm::vec4(-(lightFromWorldRotation * light.position), 1);
    return result;
}

glm::vec2 halfSize(const AreaLight& light) {
    switch (light.shape) {
    case LightShape::Rectangle: return 0.5f * light.size;
    case LightShape::Disk: return glm::vec2(0.5f * light.size.x);
    case LightShape::Directional: return glm::vec2(std::tan(0.5f * glm::radians(light.size.x)));
    }
    return {};
}

glm::vec2 lightPoint(const AreaLight& light, glm::vec2 u) {
    const glm::vec2 square = 2.0f * u - 1.0f;
    return halfSize(light) * (light.shape == LightShape::Rectangle ? square : concentricDisk(square));
}

} // namespace penumbra
