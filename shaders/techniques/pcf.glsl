// SPDX-License-Identifier: MIT
// The mean of many comparisons; see renderer/techniques/pcf.cpp.
#include "shadow_lookup.glsl"
#include "lib/sampling.glsl"

float entry(int i) { return table[i >> 2][i & 3]; }

#if SHAPE == SHAPE_POISSON
float filtered(Lookup l, Receiver r)
{
    float angle = rotate != 0 ? 6.2831853 * gradientNoise(vec2(r.pixel)) : 0.0;
    mat2 turn = 0.5 * float(kernel) * mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
    float sum = 0.0;
    int n = r.known < 0.0 ? taps : 0;
    for (int i = 0; i < n; ++i) {
        vec2 place = l.texel + turn * vec2(entry(2 * i), entry(2 * i + 1));
#if BILINEAR
        sum += blocksBilinear(l, place);
#else
        sum += blocksAt(l, place);
#endif
    }
    return sum / float(taps);
}
#else
// Texel by texel, each compared once. Along one axis the weight of texel k of the bilinear filter is
// (1 − f) w_k + f w_{k−1}, with f the receiver's fraction between the texel centres.
float filtered(Lookup l, Receiver r)
{
    float half_n = 0.5 * float(kernel - 1);
#if BILINEAR
    vec2 corner = floor(l.texel - half_n - 0.5);
    vec2 f = l.texel - half_n - 0.5 - corner;
    int n = kernel + 1;
#else
    vec2 corner = floor(l.texel - half_n);
    vec2 f = vec2(0.0);
    int n = kernel;
#endif
    int rows = r.known < 0.0 ? n : 0;
    vec2 delta = corner + 0.5 - l.texel;
    float sum = 0.0;
    float before_y = 0.0;
    for (int y = 0; y < rows; ++y) {
        float w_y = y < kernel ? entry(y) : 0.0;
        float row = 0.0;
        float before_x = 0.0;
        for (int x = 0; x < n; ++x) {
            float w_x = x < kernel ? entry(x) : 0.0;
            float z = storedDepth(corner + vec2(x, y));
            row += mix(w_x, before_x, f.x) * blocks(l, z, delta + vec2(x, y));
            before_x = w_x;
        }
        sum += mix(w_y, before_y, f.y) * row;
        before_y = w_y;
    }
    return sum;
}
#endif

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, false);
    writeShadow(r, clamp(filtered(l, r), 0.0, 1.0));
}
