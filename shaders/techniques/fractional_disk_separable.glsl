// SPDX-License-Identifier: MIT
// The published pre-processing in two passes: along rows (ROWS), then along columns. A square's least depth is separable,
// and so is the distance whose circles are squares: max(|Δx|, |Δy|) over the edges of a column's rows. 2 n + 1 texture
// reads a texel and pass.
#include "band.glsl"
#include "lib/fractional_disk.glsl"

#ifdef ROWS
uniform sampler2D edges;
uniform writeonly image2D rows; // least depth, distance along the row [texels]
#else
uniform sampler2D edges;
uniform sampler2D rows;
uniform writeonly image2D prepared;
#endif

const float unreached = 1e6;

void main()
{
    ivec2 t = texelHere().xy;
    ivec2 size = textureSize(edges, 0);
    float depth = 1.0;
    float distance = unreached;
#ifdef ROWS
    for (int x = max(t.x - maxRadius, 0); x <= min(t.x + maxRadius, size.x - 1); ++x) {
        vec2 other = texelFetch(edges, ivec2(x, t.y), 0).yz;
        depth = min(depth, other.x);
        distance = other.y > 0.0 ? min(distance, abs(float(x - t.x))) : distance;
    }
    imageStore(rows, t, vec4(depth, distance, 0.0, 0.0));
#else
    for (int y = max(t.y - maxRadius, 0); y <= min(t.y + maxRadius, size.y - 1); ++y) {
        vec2 other = texelFetch(rows, ivec2(t.x, y), 0).xy;
        depth = min(depth, other.x);
        distance = min(distance, max(other.y, abs(float(y - t.y))));
    }
    float own = texelFetch(edges, t, 0).x;
    imageStore(prepared, t, vec4(own, depth, inverseDistance(distance, float(maxRadius)), 0.0));
#endif
}
