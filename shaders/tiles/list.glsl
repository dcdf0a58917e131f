// SPDX-License-Identifier: MIT
// Lists the tiles that are marked.
#include "tiles.glsl"

layout(local_size_x = 64) in;
TILE_SET(overTiles, over)

void main()
{
    uint i = gl_GlobalInvocationID.x, all = over.width * over.height;
    if (i < all && over.words[i] != 0u)
        over.words[all + atomicAdd(over.listed, 1u)] = i / over.width << 16 | i % over.width;
}
