// SPDX-License-Identifier: MIT
// How surfaces look in ambient light and the area light, and how much of that a shadow decides.
#pragma once

#include "renderer/inputs.h"

namespace penumbra {

// A linear image "lit" of the size of `shadow`, the share of the light that is not seen.
Image shade(Flow& flow, Scope scope, const View& view, const AreaLight& light, const GeometryBuffer& buffer,
            const Shading& shading, Image shadow);

// An image "attenuation" of the size of the geometry buffer: by how much the brightest channel on the screen falls, in
// [0, 1] of its range, when the whole light is hidden. Errors of ψ are seen so much smaller.
Image drawAttenuation(Flow& flow, const View& view, const AreaLight& light, const GeometryBuffer& buffer,
                      const Shading& shading);

} // namespace penumbra
