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
// Texel by texel, each compared once, four to a gather. Along one axis the weight of texel k of the bilinear filter is
// (1 − f) w_k + f w_{k−1}, with f the receiver's fraction between the texel centres; n + 1 texels, an even number.
#if SHAPE == SHAPE_BOX
float weight(int k) { return k >= 0 && k < kernel ? entry(0) : 0.0; } // all alike: no indexed read
#else
float weight(int k) { return k >= 0 && k < kernel ? entry(k) : 0.0; }
#endif

float filtered(Lookup l, Receiver r)
{
    float half_n = 0.5 * float(kernel - 1);
#if BILINEAR
    vec2 corner = floor(l.texel - half_n - 0.5);
    vec2 f = l.texel - half_n - 0.5 - corner;
#else
    vec2 corner = floor(l.texel - half_n);
    vec2 f = vec2(0.0);
#endif
    int rows = r.known < 0.0 ? kernel : 0;
    vec2 delta = corner + 0.5 - l.texel;
    float sum = 0.0;
    for (int y = 0; y < rows; y += 2) {
        vec2 w_y = mix(vec2(weight(y), weight(y + 1)), vec2(weight(y - 1), weight(y)), f.y);
        for (int x = 0; x < kernel; x += 2) {
            vec2 w_x = mix(vec2(weight(x), weight(x + 1)), vec2(weight(x - 1), weight(x)), f.x);
            vec4 z = gatheredDepths(corner + vec2(x, y));
            vec2 d = delta + vec2(x, y);
            sum += w_y.x * (w_x.x * blocks(l, z.w, d) + w_x.y * blocks(l, z.z, d + vec2(1, 0)));
            sum += w_y.y * (w_x.x * blocks(l, z.x, d + vec2(0, 1)) + w_x.y * blocks(l, z.y, d + vec2(1, 1)));
        }
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
