// SPDX-License-Identifier: MIT
// One filtered sample of an exponential of the depth, or comparisons of the whole kernel where it says nothing; see
// renderer/techniques/esm.cpp.
#include "moment_lookup.glsl"

// How far the estimate may exceed full visibility before it is doubted: rounding and the slope of what is nearly flat.
const float tolerance = 0.05;

// The kernel's Gaussian over comparisons with the receiver's plane, bilinear as the map's lookup is.
float compared(Receiver r, int half_n)
{
    Lookup l = atProbedDepth(makeLookup(r, depthBias, slopeBias, true, false));
    vec2 corner = floor(l.texel - 0.5);
    vec2 f = l.texel - 0.5 - corner;
    float sum = 0.0;
    for (int y = -half_n; y <= half_n + 1; ++y) {
        float w_y = bilinearWeight(y, half_n, f.y);
        for (int x = -half_n; x <= half_n + 1; ++x) {
            float w_x = bilinearWeight(x, half_n, f.x);
            vec2 place = corner + vec2(x, y);
            sum += w_x * w_y * blocks(l, storedDepth(place), place + 0.5 - l.texel);
        }
    }
    return sum;
}

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    float visible = momentsAt(m).x * exp(-lookup.depth_exponents.z * clamp(m.depth, -0.5, 0.5));
    bool doubted = fallback != 0 && !(visible <= 1.0 + tolerance) && !m.known && r.known < 0.0;
    float filtered = compared(r, doubted ? kernel / 2 : -2);
    writeMomentShadow(r, m, clamp(doubted ? filtered : 1.0 - visible, 0.0, 1.0));
}
