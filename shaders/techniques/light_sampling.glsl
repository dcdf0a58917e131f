// SPDX-License-Identifier: MIT
// One more map counted: does it hide its point of the light? 1 texture read a pixel. See
// renderer/techniques/light_sampling.cpp.
#include "shadow_lookup.glsl"

#ifdef MORE
uniform sampler2D before; // the count of the maps before
#endif
uniform writeonly image2D count;

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, true, false);
    bool belowHorizon = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    float hidden = r.known >= 0.0 ? r.known : belowHorizon ? 1.0 : blocksAt(l, l.texel);
#ifdef MORE
    hidden += texelFetch(before, r.pixel, 0).x;
#endif
    imageStore(count, r.pixel, vec4(hidden));
}
