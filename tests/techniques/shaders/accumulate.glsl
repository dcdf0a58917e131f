// SPDX-License-Identifier: MIT
// Adds a number to an image: last frame's, or the round's before.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = 0) uniform Constants { vec4 added; };
#ifdef BEFORE
uniform sampler2D before;
#endif
uniform writeonly image2D sum;
uniform uvec3 bandOrigin;
void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy + bandOrigin.xy);
    float value = added.x;
#ifdef BEFORE
    value += texelFetch(before, p, 0).x;
#endif
    imageStore(sum, p, vec4(value));
}
