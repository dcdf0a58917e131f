// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace make_scenes {

// A PNG of size² texels, each the mean of 4 x 4 points of `colour`, which maps (u, v) in [0, 1]² (v downwards) to sRGB
// and alpha in [0, 1]. Stored uncompressed, so that the bytes do not depend on the version of a library.
std::vector<uint8_t> picture(unsigned size, const std::function<glm::dvec4(double u, double v)>& colour);

} // namespace make_scenes
