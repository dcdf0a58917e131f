// SPDX-License-Identifier: MIT
#include "renderer/scene/light.h"

#include <algorithm>
#include <array>

namespace penumbra {
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
    if (light.shape == LightShape::Rectangle) return halfSize(light) * square;
    const PlanePoint p = concentricDisk({square.x, square.y});
    return halfSize(light) * glm::vec2(p.x, p.y);
}

glm::vec2 haltonPoint(uint32_t i) {
    const auto inverse = [](uint32_t rest, uint32_t base) {
        double value = 0, share = 1;
        for (; rest > 0; rest /= base) value += (share /= base) * (rest % base);
        return std::min(static_cast<float>(value), 0x1.fffffep-1f); // rounding must not reach 1
    };
    return {inverse(i, 2), inverse(i, 3)};
}

} // namespace penumbra
