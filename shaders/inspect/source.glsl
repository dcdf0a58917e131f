// SPDX-License-Identifier: MIT
// One layer and level of any image, or one sample of a multisampled one, texel by texel from the upper left.
#include "shared/inspect.glsl.h"

#ifdef MULTISAMPLED
uniform sampler2DMS source;
#elif defined(ARRAY)
uniform sampler2DArray source;
#elif defined(WHOLE)
uniform usampler2D source;
#else
uniform sampler2D source;
#endif

vec4 sourceTexel(ivec4 place, ivec2 texel)
{
    ivec2 fromBelow = ivec2(texel.x, place.w - 1 - texel.y);
#ifdef ARRAY
    return texelFetch(source, ivec3(fromBelow, place.x), place.y);
#else
    return vec4(texelFetch(source, fromBelow, place.y));
#endif
}

// Not isnan and isinf: a compiler may take numbers for finite.
const uint magnitudeBits = 0x7fffffffu, infinity = 0x7f800000u;
bool isNotANumber(float v) { return (floatBitsToUint(v) & magnitudeBits) > infinity; }
bool isInfinite(float v) { return (floatBitsToUint(v) & magnitudeBits) == infinity; }

// The marks that a value earns, 1 << mark each.
uint marksOf(float v, float low, float high)
{
    if (isNotANumber(v)) return 1u;
    if (isInfinite(v)) return 2u;
    return (v < 0.0 ? 4u : 0u) | (low < high && (v < low || v > high) ? 8u : 0u);
}

vec3 shown(vec4 texel, ivec4 channels) { return vec3(texel[channels.x], texel[channels.y], texel[channels.z]); }

uint marksOf(vec3 v, SourceBlock s)
{
    return marksOf(v.x, s.statedLow.x, s.statedHigh.x) | marksOf(v.y, s.statedLow.y, s.statedHigh.y) |
           marksOf(v.z, s.statedLow.z, s.statedHigh.z);
}

// (v − low) / (high − low), for ranges up to all of float.
float placeIn(float v, float low, float high) { return (0.5 * v - 0.5 * low) / (0.5 * high - 0.5 * low); }
