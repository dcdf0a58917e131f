// SPDX-License-Identifier: MIT
// One comparison with the light's centre. 1 texture read a pixel.
#include "shadow_lookup.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, false, false);
    bool centreBelowHorizon = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    writeShadow(r, centreBelowHorizon ? 1.0 : blocksAt(l, l.texel));
}
