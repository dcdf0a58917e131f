// SPDX-License-Identifier: MIT
// Jump flooding (Rong and Tan 2006): each texel keeps the nearest edge that it or its eight neighbours `jump` texels away
// know of. Jumps that halve down to 1, and one more of 1, find the nearest in Euclid's sense. 9 texture reads a texel.
#include "band.glsl"
#include "lib/fractional_disk.glsl"

layout(std140, binding = 0) uniform Constants { ivec4 jump; };

uniform sampler2D edges;
#ifndef FIRST
uniform sampler2D before;
#endif
#ifdef LAST
uniform writeonly image2D prepared;
#else
uniform writeonly image2D flood; // centre of the nearest edge texel [texels]; 0: none yet
#endif

// What a texel knows; outside the map it is 0, nothing.
vec2 known(ivec2 texel)
{
#ifdef FIRST
    return texelFetch(edges, texel, 0).z > 0.0 ? vec2(texel) + 0.5 : vec2(0.0);
#else
    return texelFetch(before, texel, 0).xy;
#endif
}

void main()
{
    ivec2 t = texelHere().xy;
    vec2 here = vec2(t) + 0.5;
    vec2 nearest = vec2(0.0);
    float least = 1e12;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec2 seed = known(t + jump.x * ivec2(x, y));
            vec2 to = seed - here;
            float d2 = seed.x > 0.0 ? dot(to, to) : 1e12;
            nearest = d2 < least ? seed : nearest;
            least = min(d2, least);
        }
#ifdef LAST
    float own = texelFetch(edges, t, 0).x;
    float n = float(maxRadius);
    float inverse = inverseDistance(sqrt(least), n);
    float depth = texelFetch(edges, ivec2(nearest), 0).y;
    imageStore(prepared, t, vec4(own, inverse > 0.0 ? depth : 1.0, inverse, 0.0));
#else
    imageStore(flood, t, vec4(nearest, 0.0, 0.0));
#endif
}
