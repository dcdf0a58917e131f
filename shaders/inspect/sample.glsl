// SPDX-License-Identifier: MIT
// Values for quantiles: one texel of each of some hundred by hundred even cells, at a place that differs from cell to
// cell, so that no pattern of the image hides.
#include "lib/sampling.glsl"
#include "inspect/source.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, binding = 0) uniform Constants { SampleBlock block; };
layout(std430, binding = 0) writeonly buffer Result { float values[]; }; // channel by channel

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy), cells = block.cells.xy;
    if (any(greaterThanEqual(cell, cells))) return;
    vec2 size = vec2(block.source.place.zw);
    ivec2 texel = ivec2((vec2(cell) + pixelShift(vec2(cell))) * size / vec2(cells));
    vec3 v = shown(sourceTexel(block.source.place, min(texel, block.source.place.zw - 1)), block.source.channels);
    for (int i = 0; i < shownChannels; ++i) values[(i * cells.y + cell.y) * cells.x + cell.x] = v[i];
}
