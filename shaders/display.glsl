// SPDX-License-Identifier: MIT
// Linear light to sRGB for the screen, or ψ as a picture: white is lit; two such images beside each other (COMPARED); or
// errors as colours (ERROR_MAP): red too dark, blue too light, white right. 1 texture read a pixel.
#include "band.glsl"
#include "lib/srgb.glsl"
#ifdef ERROR_MAP
#include "lib/colour_map.glsl"
#endif

layout(std140, binding = 0) uniform Constants {
    vec4 exposure_show; // x = factor on linear light, y = 0: lit, 1: ψ
    vec4 halves;        // x = first column that shows `other`, y = the column where that image begins
    vec4 gain;          // x = factor on errors
};
uniform sampler2D shown;
#ifdef COMPARED
uniform sampler2D other;
#endif
uniform writeonly image2D display;

vec3 colourOf(vec4 value)
{
    if (exposure_show.y != 0.0)
        return vec3(1.0 - value.x);
    vec3 linear = clamp(value.rgb * exposure_show.x, 0.0, 1.0);
    return vec3(srgbFromLinear(linear.r), srgbFromLinear(linear.g), srgbFromLinear(linear.b));
}

#ifdef ERROR_MAP
// What is not counted is dark and striped.
vec3 errorColour(vec2 error_counted, ivec2 pixel)
{
    float error = error_counted.x;
    if (error_counted.y == 0.0)
        return vec3(((pixel.x + pixel.y) & 8) == 0 ? 0.13 : 0.17);
    return isnan(error) ? vec3(1.0, 0.0, 1.0) : diverging(clamp(error * gain.x, -1.0, 1.0));
}
#endif

void main()
{
    ivec2 pixel = texelHere().xy;
#ifdef ERROR_MAP
    vec3 colour = errorColour(texelFetch(shown, pixel, 0).xy, pixel);
#else
    vec4 value = texelFetch(shown, pixel, 0);
#ifdef COMPARED
    if (pixel.x >= int(halves.x))
        value = texelFetch(other, pixel - ivec2(halves.y, 0), 0);
#endif
    vec3 colour = colourOf(value);
#endif
    imageStore(display, pixel, vec4(colour, 1.0));
}
