// SPDX-License-Identifier: MIT
// ψ is the share of the maps that hide their point of the light.
#include "band.glsl"

layout(std140, binding = 0) uniform Constants { vec4 maps; };
uniform sampler2D counted;
uniform writeonly image2D shadow;
#ifdef KEEP
uniform writeonly image2D total; // for the next frame
#endif

void main()
{
    ivec2 pixel = texelHere().xy;
    float hidden = texelFetch(counted, pixel, 0).x;
    imageStore(shadow, pixel, vec4(hidden / maps.x));
#ifdef KEEP
    imageStore(total, pixel, vec4(hidden));
#endif
}
