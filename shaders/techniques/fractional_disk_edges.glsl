// SPDX-License-Identifier: MIT
// Where the map's hard boundaries are: the first pass of the pre-processing. A texel is on one if depth bends there by
// more than a threshold from its left to its right or its lower to its upper neighbour; slopes do not bend. 9 texture
// reads a texel.
#include "band.glsl"
#include "lib/fractional_disk.glsl"

uniform sampler2D shadowMap;
uniform writeonly image2D edges; // depth, least depth of the neighbourhood, 1 on an edge; elsewhere depth, 1, 0
#ifdef SEEDS
uniform writeonly image2D seeds; // what jump flooding starts with
#endif

float at(ivec2 texel) { return texelFetch(shadowMap, clamp(texel, ivec2(0), textureSize(shadowMap, 0) - 1), 0).x; }

void main()
{
    ivec2 t = texelHere().xy;
    float centre = at(t);
    vec4 cross = vec4(at(t + ivec2(-1, 0)), at(t + ivec2(1, 0)), at(t + ivec2(0, -1)), at(t + ivec2(0, 1)));
    vec4 corners = vec4(at(t + ivec2(-1, -1)), at(t + ivec2(1, -1)), at(t + ivec2(-1, 1)), at(t + ivec2(1, 1)));
    vec2 bend = abs(cross.xz + cross.yw - 2.0 * centre);
    bool edge = max(bend.x, bend.y) > edgeThreshold;
    vec4 less = min(cross, corners);
    float least = min(centre, min(min(less.x, less.y), min(less.z, less.w)));
    bool found = edge && least < 1.0;
    imageStore(edges, t, found ? vec4(centre, least, 1.0, 0.0) : vec4(centre, 1.0, 0.0, 0.0));
#ifdef SEEDS
    imageStore(seeds, t, vec4(found ? 0.0 : floodUnknown));
#endif
}
