// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/scene/scene.h"

namespace penumbra {

// Boxes in model space that together hold the triangles of a primitive at rest, at most 64: a shadow map that is fitted
// to them wastes fewer texels than one that is fitted to a single box. Empty where one box does as well.
std::vector<Bounds> partBounds(const Scene& scene, const Primitive& primitive);

} // namespace penumbra
