// SPDX-License-Identifier: MIT
// How far one shadow image is from the truth (TRUTH) or from another one, and where that counts. 2 or 3 reads a pixel.
#include "band.glsl"

uniform sampler2D shadow; // ψ
uniform sampler2D other;  // x = ψ* or the other ψ; of the truth y = 1 where errors are counted
#ifndef TRUTH
uniform sampler2D depth; // 0: no surface
#endif
uniform writeonly image2D error;

void main()
{
    ivec2 pixel = texelHere().xy;
    vec2 subtrahend = texelFetch(other, pixel, 0).xy;
#ifdef TRUTH
    float counted = subtrahend.y;
#else
    float counted = texelFetch(depth, pixel + (textureSize(depth, 0) - imageSize(error)) / 2, 0).x > 0.0 ? 1.0 : 0.0;
#endif
    imageStore(error, pixel, vec4(texelFetch(shadow, pixel, 0).x - subtrahend.x, counted, 0.0, 0.0));
}
