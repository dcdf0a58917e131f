// SPDX-License-Identifier: MIT
// Sets of tiles, 8 texels of a row each (TileSet in renderer/core/flow.h). A shader that marks tiles of a set says
// TILE_SET(nameTiles, name) and MARK(name, texel).
//
// In the buffer: the groups to dispatch; how many tiles are listed; the grid; then a mark for each tile, row by row; then
// the list, a tile's row in the upper half of a word.
#define TILE_BLOCK(name)                                                                                                   \
    {                                                                                                                      \
        uint groupsX, groupsY, groupsZ;                                                                                    \
        uint listed;                                                                                                       \
        uint width, height;                                                                                                \
        uint unused0, unused1;                                                                                             \
        uint words[];                                                                                                      \
    }                                                                                                                      \
    name;
#define TILE_SET(block, name) layout(std430) buffer block TILE_BLOCK(name)

// Any number of invocations may mark the same tile. Texels outside the image mark nothing.
#define MARK(name, texel)                                                                                                  \
    {                                                                                                                      \
        uvec2 tile = uvec2(uint((texel).x) >> 3, uint((texel).y));                                                                                    \
        if (tile.x < name.width && tile.y < name.height) name.words[tile.y * name.width + tile.x] = 1u;                    \
    }
