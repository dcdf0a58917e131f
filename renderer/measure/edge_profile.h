// SPDX-License-Identifier: MIT
// Across the edge of a shadow: ψ along a line of pixels, and how wide the penumbra is on it.
#pragma once

#include "renderer/scene/camera.h"

#include <optional>
#include <span>
#include <vector>

namespace penumbra {

// Values of an image, row 0 at the top, at `count` places evenly from one point to another, both included; bilinear.
// Points are in pixels from the upper left corner, centres at ½; beyond the outermost centres the border's value holds.
void sampleLine(std::span<const float> image, glm::ivec2 size, glm::vec2 from, glm::vec2 to, size_t count,
                std::vector<float>& profile);

// Where a profile passes 10 and 90 percent, in samples from its first one; between two samples in proportion.
struct EdgeWidth {
    double at10, at90;
    double samples() const { return at90 > at10 ? at90 - at10 : at10 - at90; }
};
// Of the edge that is nearest to the profile's middle: a passage of one level that is followed by one of the other.
// None where no such pair is on the line.
std::optional<EdgeWidth> edgeWidth(std::span<const float> profile);

// The surface at a point of the picture, from eye depths, row 0 at the top: between the centres of pixels 1 / depth is
// interpolated, which is exact on a plane. Nothing where the nearest pixel shows no surface.
std::optional<glm::vec3> surfaceWorld(const View& view, std::span<const float> depth, glm::vec2 place);
// Whether one surface goes on from one point of the picture to another. Where a nearer one ends between them, the
// distance of their points says nothing of a penumbra's width.
bool onOneSurface(const View& view, std::span<const float> depth, glm::vec2 from, glm::vec2 to);

} // namespace penumbra
