// SPDX-License-Identifier: MIT
// What every imported scene promises to whoever draws it, however broken its file was.
#pragma once

#include "renderer/scene/scene.h"

namespace penumbra::test {

// Throws std::logic_error for the first promise that is broken: ranges that lie inside their lists, parents before
// children, unit normals, weights that sum to 1, and finite numbers throughout - at rest and at several times of every
// clip - up to the vertices, the bounds, and the camera, light and ground made for them.
void checkPromises(const Scene& scene);

} // namespace penumbra::test
