// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/scene/scene.h"

namespace penumbra {

// Whether a primitive's triangles enclose a volume, all facing outwards: every edge is run through as often one way as
// the other (corners at the same place count as one), and every connected part has a positive volume. Seen from outside
// its bounds, the nearest surface of such a primitive always faces the viewer.
bool isClosedSurface(const Scene& scene, const Primitive& primitive);

// Whether a part of a primitive may stand between another part and a light that this one faces: not if it is flat, nor
// if it is closed and convex, both to 1e-5 of its size. Large primitives are not looked into, and may.
bool mayShadeItself(const Scene& scene, const Primitive& primitive);

} // namespace penumbra
