// SPDX-License-Identifier: MIT
// Adds the constant where it runs.
#include "band.glsl"
layout(std140, binding = 0) uniform Constants { vec4 added; };
layout(r32f) uniform image2D sum;
void main()
{
    ivec2 texel = texelHere().xy;
    imageStore(sum, texel, imageLoad(sum, texel) + added);
}
