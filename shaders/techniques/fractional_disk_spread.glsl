// SPDX-License-Identifier: MIT
// One pass of the published pre-processing: the least occluder depth of the neighbourhood, and one unit more for every
// texel that a boundary has reached. 9 texture reads a texel.
#include "band.glsl"
#include "lib/fractional_disk.glsl"

uniform sampler2D before;
uniform writeonly image2D prepared;

void main()
{
    ivec2 t = texelHere().xy;
    ivec2 last = textureSize(before, 0) - 1;
    vec3 own = texelFetch(before, t, 0).xyz;
    vec2 found = own.yz; // least depth, greatest inverse distance
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec2 other = texelFetch(before, clamp(t + ivec2(x, y), ivec2(0), last), 0).yz;
            found = vec2(min(found.x, other.x), max(found.y, other.y));
        }
    // The text has one unit more than the neighbourhood's greatest, which is the same wherever anything is.
#if LISTING == LISTING_DISTANCE || LISTING == LISTING_AS_PRINTED
    float inverse = found.y + 1.0;
#else
    float inverse = own.z + 1.0;
#endif
    imageStore(prepared, t, vec4(own.x, found.x, found.y > 0.0 ? inverse : 0.0, 0.0));
}
