// SPDX-License-Identifier: MIT
// A summed-area table (Crow 1984) of the moments of a shadow map, in whole numbers: sums wrap around at 2³² and are exact all
// the same, since the sum over a box is a difference of four that is below 2³².
//
// Along rows, then along columns, an invocation sums up a run of texels: first its total (TOTALS), then, from the sum of the
// totals before it, what every texel has before and in it. 3 reads and a write a texel in either direction.
#include "band.glsl"
#include "shared/summed_area.glsl.h"
#include "lib/moments.glsl"

#ifdef ROWS
layout(std140, binding = 0) uniform Constants { SummedAreaBlock table; };
uniform sampler2D source;
uvec4 wordsAt(ivec2 place)
{
    float x = fma(texelFetch(source, place, 0).x, table.depth_levels.x, table.depth_levels.y);
    vec4 stored = table.storedFromMoments * powersOf(x) + table.storedOffset;
    return uvec4(clamp(stored, 0.0, 1.0) * table.depth_levels.z + 0.5);
}
const ivec2 along = ivec2(1, 0), across = ivec2(0, 1);
#else
uniform usampler2D source;
uvec4 wordsAt(ivec2 place) { return texelFetch(source, place, 0); }
const ivec2 along = ivec2(0, 1), across = ivec2(1, 0);
#endif

#ifdef TOTALS
#ifdef ROWS
uniform writeonly uimage2D rowTotals;
#define written rowTotals
#else
uniform writeonly uimage2D columnTotals;
#define written columnTotals
#endif
#else
uniform usampler2D totals;
#ifdef ROWS
uniform writeonly uimage2D rowStarts, rowSums;
#define starts rowStarts
#define written rowSums
#else
uniform writeonly uimage2D columnStarts, summedArea;
#define starts columnStarts
#define written summedArea
#endif
#endif

void main()
{
    ivec2 place = texelHere().xy;
    int run = place.x * along.x + place.y * along.y;
    ivec2 line = place * across;
    ivec2 size = textureSize(source, 0);
    bool within = all(lessThan(line, size));
    int first = run * runLength;
    int texels = within ? clamp(size.x * along.x + size.y * along.y - first, 0, runLength) : 0;
    uvec4 sum = uvec4(0u);
#ifdef TOTALS
    for (int i = 0; i < texels; ++i) sum += wordsAt(line + along * (first + i));
    imageStore(written, place, sum);
#else
    for (int i = 0; i < (within ? run : 0); ++i) sum += texelFetch(totals, line + along * i, 0);
    imageStore(starts, place, sum);
    for (int i = 0; i < texels; ++i) {
        ivec2 texel = line + along * (first + i);
        sum += wordsAt(texel);
        imageStore(written, texel, sum);
    }
#endif
}
