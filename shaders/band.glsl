// SPDX-License-Identifier: MIT
// Which texel of the written images an invocation makes; every pass over texels includes this and asks texelHere(). A dear
// pass runs in bands, each a dispatch of its own whose groups count from 0 again.
#include "tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef OVER_TILES
TILE_SET(overTiles, over)

uniform uvec3 bandOrigin; // x = the band's first listed tile

ivec3 texelHere()
{
    uint i = bandOrigin.x + gl_WorkGroupID.x * 8u + gl_LocalInvocationID.y;
    uint tile = over.words[over.width * over.height + i]; // past the last: 0
    return i < over.listed ? ivec3((tile & 0xffffu) * 8u + gl_LocalInvocationID.x, tile >> 16, 0) : ivec3(-1);
}
#else
uniform uvec3 bandOrigin; // the band's first texel and layer

ivec3 texelHere() { return ivec3(gl_GlobalInvocationID + bandOrigin); }
#endif
