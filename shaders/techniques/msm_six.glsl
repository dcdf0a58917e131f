// SPDX-License-Identifier: MIT
// Algorithm 2 for six moments on one filtered sample of both layers; see renderer/techniques/msm_six.cpp.
#include "moment_lookup.glsl"
#include "lib/moments_six.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    // Mixed in: the arcsine distribution, of all on [−1, 1] the one whose polynomials have the largest norms D_j in the limit.
    float alpha = lookup.range.x;
    vec4 low = momentsAt(m, 0) + alpha * vec4(0.0, 0.5, 0.0, 0.375);
    vec4 high = momentsAt(m, 1) + alpha * vec4(0.0, 0.3125, 0.0, 0.0);
    // Its own D1, D2, D3; what rounding may leave of nothing.
    vec3 least = max(alpha * vec3(0.5, 0.125, 0.03125), vec3(1e-7, 1e-8, 1e-9));
    writeMomentShadow(r, m, sixMomentsBound(SixMoments(low.x, low.y, low.z, low.w, high.x, high.y), m.depth, least));
}
