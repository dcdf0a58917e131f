// SPDX-License-Identifier: MIT
// Linear light to sRGB for the screen, or ψ as a picture: white is lit. 1 texture read a pixel.
layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, binding = 0) uniform Constants {
    vec4 exposure_show; // x = factor on linear light, y = 0: lit, 1: ψ
};
uniform sampler2D shown;
uniform writeonly image2D display;

// IEC 61966-2-1
vec3 encoded(vec3 linear)
{
    linear = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec4 value = texelFetch(shown, pixel, 0);
    vec3 shownColour = exposure_show.y != 0.0 ? vec3(1.0 - value.x) : encoded(value.rgb * exposure_show.x);
    imageStore(display, pixel, vec4(shownColour, 1.0));
}
