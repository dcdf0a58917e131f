// SPDX-License-Identifier: MIT
// Cantelli's bounds on one filtered sample of warped depths; see renderer/techniques/evsm.cpp.
#include "moment_lookup.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    vec4 b = momentsAt(m);
    float x = clamp(m.depth, -1.0, 1.0);
    vec2 c = lookup.depth_exponents.zw;
    vec2 deviation = 2.0 * minimumDeviation * c; // of a warp, relative to it
    float psi = warpedVarianceBound(b.xy, exp(c.x * x), deviation.x);
    float negative = warpedVarianceBound(b.zw, -exp(-c.y * x), deviation.y);
    psi = components == COMPONENTS_4 ? max(psi, negative) : psi;
    writeMomentShadow(r, m, withoutBleeding(psi, bleedingReduction));
}
