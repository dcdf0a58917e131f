// SPDX-License-Identifier: MIT
// Linear light to sRGB for the screen, or ψ as a picture: white is lit. 1 texture read a pixel.
#include "band.glsl"
#include "lib/srgb.glsl"

layout(std140, binding = 0) uniform Constants {
    vec4 exposure_show; // x = factor on linear light, y = 0: lit, 1: ψ
};
uniform sampler2D shown;
uniform writeonly image2D display;

void main()
{
    ivec2 pixel = texelHere().xy;
    vec4 value = texelFetch(shown, pixel, 0);
    vec3 linear = clamp(value.rgb * exposure_show.x, 0.0, 1.0);
    vec3 encoded = vec3(srgbFromLinear(linear.r), srgbFromLinear(linear.g), srgbFromLinear(linear.b));
    vec3 shownColour = exposure_show.y != 0.0 ? vec3(1.0 - value.x) : encoded;
    imageStore(display, pixel, vec4(shownColour, 1.0));
}
