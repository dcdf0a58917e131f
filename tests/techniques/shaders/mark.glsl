// SPDX-License-Identifier: MIT
// Marks the tiles of two single texels, and one outside the image.
#include "band.glsl"
TILE_SET(someTiles, some)
uniform writeonly image2D sum;
void main()
{
    ivec2 texel = texelHere().xy;
    imageStore(sum, texel, vec4(1.0));
    if (texel == ivec2(9, 2) || texel == ivec2(42, 20)) MARK(some, texel)
    if (texel == ivec2(0, 0)) MARK(some, ivec2(-1, 5))
    if (texel == ivec2(0, 0)) MARK(some, ivec2(3, 21))
}
