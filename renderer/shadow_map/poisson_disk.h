// SPDX-License-Identifier: MIT
// Points for filters, even but without a pattern.
#pragma once

#include <glm/glm.hpp>

#include <span>

namespace penumbra {

// n points of the unit disk by best candidate (Mitchell 1991): each is the farthest of many from those before it, and
// from the disk's copies around it nothing is asked. The same points for the same n.
std::span<const glm::vec2> poissonDisk(int n);

} // namespace penumbra
