// SPDX-License-Identifier: MIT
// Cantelli's bound on windows of a summed-area table; see renderer/techniques/vsm_soft.cpp.
#include "soft_moments.glsl"

InFront blockingIn(vec4 b, float z_f)
{
    float unit = lookup.depth.x; // of depth, in depth ranges
    return varianceInFront(b.xy, z_f, max(minimumVariance * unit * unit, 1e-12));
}
