// SPDX-License-Identifier: MIT
// ψ is the share of the maps that hide their point of the light.
layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, binding = 0) uniform Constants { vec4 maps; };
uniform sampler2D counted;
uniform writeonly image2D shadow;
#ifdef KEEP
uniform writeonly image2D total; // for the next frame
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    float hidden = texelFetch(counted, pixel, 0).x;
    imageStore(shadow, pixel, vec4(hidden / maps.x));
#ifdef KEEP
    imageStore(total, pixel, vec4(hidden));
#endif
}
