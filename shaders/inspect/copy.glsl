// SPDX-License-Identifier: MIT
// A rectangle of an image as plain floats, upper row first: multisampled images have no other way out.
#include "inspect/source.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, binding = 0) uniform Constants {
    SourceBlock block;
    ivec4 rectangle; // upper left texel, width, height
};
uniform writeonly image2D copied;

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, rectangle.zw)))
        imageStore(copied, texel, sourceTexel(block.place, rectangle.xy + texel));
}
