// SPDX-License-Identifier: MIT
// Jump flooding (Rong and Tan 2006): each texel keeps the nearest edge that it or its eight neighbours `jump` texels away
// know of. Jumps that halve down to 1, and one more of 1, find the nearest in Euclid's sense. 9 texture reads a texel.
#include "band.glsl"
#include "lib/fractional_disk.glsl"

layout(std140, binding = 0) uniform Constants { ivec4 jump; };

uniform sampler2D before;
#ifdef LAST
uniform sampler2D edges;
uniform writeonly image2D prepared;
#else
uniform writeonly image2D flood; // offset to the nearest edge texel [texels]; floodUnknown: none yet
#endif

void main()
{
    ivec2 t = texelHere().xy;
    ivec2 last = textureSize(before, 0) - 1;
    vec2 nearest = vec2(floodUnknown);
    float least = floodUnknown * floodUnknown;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 from = clamp(t + jump.x * ivec2(x, y), ivec2(0), last);
            vec2 known = texelFetch(before, from, 0).xy;
            vec2 to = known + vec2(from - t);
            float d2 = known.x < floodUnknown ? dot(to, to) : least;
            nearest = d2 < least ? to : nearest;
            least = min(d2, least);
        }
#ifdef LAST
    float own = texelFetch(edges, t, 0).x;
    float inverse = inverseDistance(sqrt(least), float(maxRadius));
    float depth = texelFetch(edges, t + ivec2(inverse > 0.0 ? nearest : vec2(0.0)), 0).y;
    imageStore(prepared, t, vec4(own, inverse > 0.0 ? depth : 1.0, inverse, 0.0));
#else
    imageStore(flood, t, vec4(nearest, 0.0, 0.0));
#endif
}
