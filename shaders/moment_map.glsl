// SPDX-License-Identifier: MIT
// A separable filter over functions of the depth: the first pass reads depths and sums along rows, the second along columns.
// Sums are of differences from a texel in the middle, so that they are exact where all depths are alike. What is written is
// larger by half a kernel on both sides: filtered, casters reach beyond themselves.
//
// An invocation filters a run of four texels, whose kernels have all but three texels in common: (kernel + 3) / 4 texture
// reads a texel, and as few evaluations of the functions. A quarter of each group's invocations has such a run, the rest
// nothing to do.
#include "band.glsl"
#include "shared/moments.glsl.h"
#include "lib/moments.glsl"
#include "lib/moments_trigonometric.glsl"
#include "lib/convolution.glsl"
#include "lib/slices.glsl"

layout(std140, binding = 0) uniform Constants { MomentFilterBlock filtering; };

#ifdef LAYERED
#define Target image2DArray
#else
#define Target image2D
#endif
#ifdef ROWS
uniform writeonly Target momentsOfRows;
#define filtered momentsOfRows
#else
uniform writeonly Target moments;
#define filtered moments
#endif

#ifdef FROM_DEPTH
#ifdef SAMPLES
uniform sampler2DMS source;
ivec2 sourceSize() { return textureSize(source); }
#else
uniform sampler2D source;
ivec2 sourceSize() { return textureSize(source, 0); }
#endif

vec4 functionsOf(float z, int layer)
{
    float x = fma(z, filtering.depth_exponents.x, filtering.depth_exponents.y);
    vec2 e = filtering.depth_exponents.zw;
#if FUNCTIONS == 0
    vec4 powers = powersOf(x);
    return layer == 0 ? powers : powers * powers.w;
#elif FUNCTIONS == 1
    return vec4(exp(e.x * x), 0.0, 0.0, 0.0);
#elif FUNCTIONS == 2
    vec2 w = vec2(exp(e.x * x), -exp(-e.y * x));
    return vec4(w.x, w.x * w.x, w.y, w.y * w.y);
#elif FUNCTIONS == 3
    return trigonometricOf(x);
#elif FUNCTIONS == 4
    return squareWaveOf(x, layer);
#else
    return slicesOf(x, layer, e.x, e.y);
#endif
}

vec4 valueAt(ivec2 place, int layer)
{
#ifdef SAMPLES
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SAMPLES; ++i) sum += functionsOf(texelFetch(source, place, i).x, layer);
    return sum / float(SAMPLES);
#else
    return functionsOf(texelFetch(source, place, 0).x, layer);
#endif
}
vec4 stored(vec4 value)
{
#ifdef ENCODED
    return filtering.storedFromMoments * value + filtering.storedOffset;
#else
    return value;
#endif
}
#else
#ifdef LAYERED
uniform sampler2DArray source;
vec4 valueAt(ivec2 place, int layer) { return texelFetch(source, ivec3(place, layer), 0); }
#else
uniform sampler2D source;
vec4 valueAt(ivec2 place, int layer) { return texelFetch(source, place, 0); }
#endif
ivec2 sourceSize() { return textureSize(source, 0).xy; }
vec4 stored(vec4 value) { return value; }
#endif

float weight(int i) { return filtering.weights[abs(i)].x; }

void store(ivec2 place, int layer, vec4 value)
{
#ifdef LAYERED
    imageStore(filtered, ivec3(place, layer), stored(value));
#else
    imageStore(filtered, place, stored(value));
#endif
}

void main()
{
    // The group's runs: two beside each other in each row, or eight in a row and two above each other.
    ivec3 texel = texelHere();
    ivec2 inGroup = ivec2(gl_LocalInvocationID.xy);
    int i = inGroup.x + 8 * inGroup.y;
#ifdef ROWS
    const ivec2 along = ivec2(1, 0);
    ivec2 first = texel.xy - inGroup + ivec2(4 * (i & 1), i >> 1);
#else
    const ivec2 along = ivec2(0, 1);
    ivec2 first = texel.xy - inGroup + ivec2(i & 7, 4 * (i >> 3));
#endif
    ivec2 last = sourceSize() - 1;
    int half_n = filtering.kernel.x;
    int rounds = i < 16 ? 1 : 0; // a loop: software renderers run both sides of a branch
    for (int round_ = 0; round_ < rounds; ++round_) {
        ivec2 start = first - half_n * along; // of the source
        vec4 middle = valueAt(clamp(start + 2 * along, ivec2(0), last), texel.z);
        vec4 a = vec4(0.0), b = vec4(0.0), c = vec4(0.0), d = vec4(0.0);
        for (int j = -half_n; j < half_n + 4; ++j) {
            vec4 difference = valueAt(clamp(start + j * along, ivec2(0), last), texel.z) - middle;
            a += weight(j) * difference;
            b += weight(j - 1) * difference;
            c += weight(j - 2) * difference;
            d += weight(j - 3) * difference;
        }
        store(first, texel.z, middle + a);
        store(first + along, texel.z, middle + b);
        store(first + 2 * along, texel.z, middle + c);
        store(first + 3 * along, texel.z, middle + d);
    }
}
