// SPDX-License-Identifier: MIT
// One filtered sample of an exponential of the depth, or comparisons of the whole kernel where it says nothing; see
// renderer/techniques/esm.cpp.
#include "moment_lookup.glsl"

// How far the estimate may exceed full visibility before it is doubted: rounding and the slope of what is nearly flat.
const float tolerance = 0.05;

float weightWithin(int i, int half_n) { return abs(i) <= half_n ? kernelWeight(i) : 0.0; }

// The kernel's Gaussian over comparisons with the receiver's plane, bilinear as the map's lookup is: along one axis texel i
// beside the one at the lower left counts (1 − f) w_i + f w_{i−1}.
float compared(Receiver r, int half_n)
{
    Lookup l = makeLookup(r, depthBias, slopeBias, true, false);
    vec2 corner = floor(l.texel - 0.5);
    vec2 f = l.texel - 0.5 - corner;
    float sum = 0.0;
    for (int y = -half_n; y <= half_n + 1; ++y) {
        float w_y = mix(weightWithin(y, half_n), weightWithin(y - 1, half_n), f.y);
        for (int x = -half_n; x <= half_n + 1; ++x) {
            float w_x = mix(weightWithin(x, half_n), weightWithin(x - 1, half_n), f.x);
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
    float visible = momentsAt(m.place).x * exp(-lookup.depth_exponents.z * clamp(m.depth, -0.5, 0.5));
    bool doubted = fallback != 0 && !(visible <= 1.0 + tolerance) && !m.known && r.known < 0.0;
    float filtered = compared(r, doubted ? kernel / 2 : -2);
    writeMomentShadow(r, m, clamp(doubted ? filtered : 1.0 - visible, 0.0, 1.0));
}
