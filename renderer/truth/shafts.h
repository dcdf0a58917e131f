// SPDX-License-Identifier: MIT
// Which points see the whole light, without any ray: those with no triangle in the shaft between them and it (after
// Haines and Wallace 1994, Shaft culling for efficient ray-traced radiosity).
#pragma once

#include "renderer/scene/light.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

// Triangles in a hierarchy of boxes.
class Shafts {
public:
    using Triangle = std::array<uint32_t, 3>; // corners, of the positions
    // `positionsWorld` [m] must outlive it.
    Shafts(const std::vector<glm::vec3>& positionsWorld, std::vector<Triangle> triangles);

    // A light as shafts have it: a parallelogram round all its points.
    struct Target {
        explicit Target(const AreaLight& light);
        glm::mat4 lightFromWorld;
        glm::vec2 half; // as halfSize()
        bool directional;
        std::array<glm::vec4, 4> cornersWorld; // w = 0: directions
    };
    // Of points that are near to each other and whose horizons the light is wholly above. Where `sees` becomes 1, every
    // ray to the light says so, but for what rounding does at a triangle's very edge; where it is 0, nothing is known.
    void look(std::span<const glm::vec3> pointsWorld, const Target& target, std::span<uint8_t> sees) const;

private:
    struct Box {
        glm::vec3 low, high;
        uint32_t first, count; // of triangles_; count 0: the boxes `first` and `first` + 1
    };
    void build(uint32_t box, uint32_t first, uint32_t count);
    struct Planes;
    static constexpr size_t most = 64; // candidates
    struct Candidates;
    bool gather(std::span<const glm::vec3> points, const Target& target, Candidates& found) const;
    glm::vec3 corner(const Triangle& triangle, size_t i) const { return positions_[triangle[i]]; }

    const std::vector<glm::vec3>& positions_;
    std::vector<Triangle> triangles_; // in the order of the boxes
    std::vector<Box> boxes_;
};

} // namespace penumbra
