// SPDX-License-Identifier: MIT
// How surfaces look in ambient light and the area light, and how much of that a shadow decides.
#pragma once

#include "renderer/inputs.h"

namespace penumbra {

// A light and ψ of it, the share that is not seen; all images of one size.
struct Shadowed {
    const AreaLight* light;
    Image shadow;
};
using ShadowedLights = FixedVector<Shadowed, 1 + mostFurtherLights>;

// A linear image "lit" of the size of the shadows.
Image shade(Flow& flow, Scope scope, const View& view, const ShadowedLights& lights, const GeometryBuffer& buffer,
            const Shading& shading);

// An image "attenuation" of the size of the geometry buffer: by how much the brightest channel on the screen falls, in
// [0, 1] of its range, when the whole light is hidden, were it the only one. Errors of ψ are seen so much smaller.
Image drawAttenuation(Flow& flow, std::string_view instance, const View& view, const AreaLight& light,
                      const GeometryBuffer& buffer, const Shading& shading);

} // namespace penumbra
