// SPDX-License-Identifier: MIT
// The area light: a rectangle or a disk with a pose and a size in metres, or a directional light with an angular
// diameter. Its size belongs to the light alone; every technique and the truth read it from here.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

namespace penumbra {

enum class LightShape { Rectangle, Disk, Directional };
std::span<const std::string_view> lightShapeNames(); // "rectangle", "disk", "directional"

struct AreaLight {
    LightShape shape = LightShape::Rectangle;
    glm::vec3 position{0, 4,
                       0};     // its centre, world [m]; a directional light has only its direction from here to target
    glm::vec3 target{0, 0, 0}; // the point that it faces, world [m]
    glm::vec2 size{1, 1};      // rectangle: full width and height [m]; disk: x = diameter [m];
                               // directional: x = angular diameter [degrees] of a disk (the sun: 0.533)
    glm::vec3 colour{1, 1, 1}; // linear, times intensity
    float intensity = 1;       // irradiance at the target when it faces the light, relative to white

    bool operator==(const AreaLight&) const = default;
};

// A light beside the one that is studied.
struct FurtherLight {
    AreaLight light;
    bool on = true;
    bool operator==(const FurtherLight&) const = default;
};
inline constexpr size_t mostFurtherLights = 3;
inline constexpr float furtherLightShare = 0.5f; // of the first one's intensity, for a new light like it

// Orthonormal; the light looks down −Z, its width is along X, which is horizontal. A light straight above or below has
// its X along world X. A light that stands on its target looks down world −Y.
glm::mat4 lightFromWorld(const AreaLight& light);

// Half the size along X and Y [m] (a disk: its radius, twice; directional: tan of the angular radius, twice, no unit).
glm::vec2 halfSize(const AreaLight& light);

// Concentric map of [−1, 1]² to the unit disk, area-preserving (Shirley and Chiu, A Low Distortion Map Between Disk and
// Square, 1997). Without branches and library calls, so that a loop over points becomes vector code; the angle is
// within ±π/4, where these Taylor polynomials err by less than a float's rounding.
struct PlanePoint {
    float x, y;
};
inline PlanePoint concentricDisk(PlanePoint square) {
    const bool wide = std::abs(square.x) > std::abs(square.y);
    const float radius = wide ? square.x : square.y, across = wide ? square.y : square.x;
    const float a = 0.785398163f * across / (radius != 0 ? radius : 1), a2 = a * a;
    const float sine = a * (1 + a2 * (-1 / 6.0f + a2 * (1 / 120.0f + a2 * (-1 / 5040.0f + a2 / 362880))));
    const float cosine = 1 + a2 * (-0.5f + a2 * (1 / 24.0f + a2 * (-1 / 720.0f + a2 / 40320)));
    return {radius * (wide ? cosine : sine), radius * (wide ? sine : cosine)};
}

// The point of the light that belongs to `u` in [0, 1)², in light space [m] (z = 0); area-preserving: rectangles
// stretch the square, disks use the concentric map. A directional light's point is the tangent offset (x, y) of its
// direction: seen from any receiver, the sample lies towards normalize((x, y, 1)) in light space, since the light looks
// down −Z and +Z points back to it.
glm::vec2 lightPoint(const AreaLight& light, glm::vec2 u);

// The i-th point of the Halton sequence of bases 2 and 3 in [0, 1)²; the 0-th is the corner (0, 0).
glm::vec2 haltonPoint(uint32_t i);
// The i-th point of the R2 sequence (Roberts 2018), an additive recurrence, in [0, 1)².
glm::vec2 r2Point(uint32_t i);
// The i-th point of a Sobol sequence in [0, 1)², nested uniformly scrambled (Owen 1995) by a seed: of the first 2^k points
// every rectangle of area 2^-k that comes of halving the sides holds one.
glm::vec2 sobolPoint(uint32_t i, uint32_t seed);
// Independent points of [0, 1)².
glm::vec2 randomPoint(uint32_t i);

} // namespace penumbra
