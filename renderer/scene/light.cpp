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

namespace {

float belowOne(double value) { return std::min(static_cast<float>(value), 0x1.fffffep-1f); } // rounding reaches 1
float fromBits(uint32_t bits) { return belowOne(static_cast<double>(bits) / 4294967296.0); }

// A permutation of 32-bit numbers: PCG (O'Neill 2014; Jarzynski, Olano 2020).
uint32_t permuted(uint32_t n) {
    n = n * 747796405u + 2891336453u;
    n = ((n >> ((n >> 28) + 4)) ^ n) * 277803737u;
    return (n >> 22) ^ n;
}

// Each bit turned or not, as chance has it for the bits above.
uint32_t scrambled(uint32_t bits, uint32_t seed) {
    uint32_t turned = 0;
    for (uint32_t bit = 0; bit < 32; ++bit) {
        const uint32_t above = bit == 31 ? 0 : bits >> (bit + 1);
        turned |= (permuted(permuted(32 * seed + bit) ^ above) >> 31) << bit;
    }
    return bits ^ turned;
}

} // namespace

glm::vec2 haltonPoint(uint32_t i) {
    const auto inverse = [](uint32_t rest, uint32_t base) {
        double value = 0, share = 1;
        for (; rest > 0; rest /= base) value += (share /= base) * (rest % base);
        return belowOne(value);
    };
    return {inverse(i, 2), inverse(i, 3)};
}

glm::vec2 r2Point(uint32_t i) {
    const glm::dvec2 point = glm::fract(static_cast<double>(i) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
    return {belowOne(point.x), belowOne(point.y)};
}

glm::vec2 sobolPoint(uint32_t i, uint32_t seed) {
    uint32_t x = 0, y = 0;
    uint32_t column = 1u << 31; // of Pascal's triangle modulo 2
    for (uint32_t k = 0; k < 32; ++k) {
        if (i >> k & 1) x |= 1u << (31 - k), y ^= column;
        column ^= column >> 1;
    }
    return {fromBits(scrambled(x, 2 * seed)), fromBits(scrambled(y, 2 * seed + 1))};
}

glm::vec2 randomPoint(uint32_t i) { return {fromBits(permuted(2 * i)), fromBits(permuted(2 * i + 1))}; }

} // namespace penumbra
