// SPDX-License-Identifier: MIT
// A separable filter over functions of the depth: the first pass reads depths and sums along rows, the second along columns.
// Sums are of differences from the centre, so that they are exact where all depths are alike. As many texture reads a texel
// as the kernel is wide.
#include "band.glsl"
#include "shared/moments.glsl.h"
#include "lib/moments.glsl"
#include "lib/moments_trigonometric.glsl"

layout(std140, binding = 0) uniform Constants { MomentFilterBlock filtering; };
uniform sampler2D source;
#ifdef ROWS
uniform writeonly image2D momentsOfRows;
#else
uniform writeonly image2D moments;
#endif

#ifdef FROM_DEPTH
vec4 functionsOf(float z)
{
    float x = fma(z, filtering.depth_exponents.x, filtering.depth_exponents.y);
    vec2 e = filtering.depth_exponents.zw;
#if FUNCTIONS == 0
    return powersOf(x);
#elif FUNCTIONS == 1
    return vec4(exp(e.x * x), 0.0, 0.0, 0.0);
#elif FUNCTIONS == 3
    return trigonometricOf(x);
#else
    vec2 w = vec2(exp(e.x * x), -exp(-e.y * x));
    return vec4(w.x, w.x * w.x, w.y, w.y * w.y);
#endif
}

vec4 valueAt(ivec2 place) { return functionsOf(texelFetch(source, place, 0).x); }
vec4 stored(vec4 value)
{
#ifdef ENCODED
    return filtering.storedFromMoments * value + filtering.storedOffset;
#else
    return value;
#endif
}
#else
vec4 valueAt(ivec2 place) { return texelFetch(source, place, 0); }
vec4 stored(vec4 value) { return value; }
#endif

#ifdef ROWS
const ivec2 along = ivec2(1, 0);
#else
const ivec2 along = ivec2(0, 1);
#endif

void main()
{
    ivec2 texel = texelHere().xy;
    ivec2 last = textureSize(source, 0) - 1;
    vec4 centre = valueAt(min(texel, last));
    vec4 sum = vec4(0.0);
    for (int i = 1; i <= filtering.kernel.x; ++i) {
        vec4 before = valueAt(max(texel - i * along, 0));
        vec4 after = valueAt(min(texel + i * along, last));
        sum += filtering.weights[i].x * ((before - centre) + (after - centre));
    }
    vec4 result = stored(centre + sum);
#ifdef ROWS
    imageStore(momentsOfRows, texel, result);
#else
    imageStore(moments, texel, result);
#endif
}
