// SPDX-License-Identifier: MIT
// How many groups, of eight tiles each, the next band over listed tiles has.
#include "tiles.glsl"

layout(local_size_x = 1) in;
TILE_SET(overTiles, over)

uniform uvec3 bandOrigin; // x = the list's tiles that are done, y = how many are wanted

void main()
{
    over.groupsX = (min(over.listed - min(bandOrigin.x, over.listed), bandOrigin.y) + 7u) / 8u;
    over.groupsY = 1u;
    over.groupsZ = 1u;
}
