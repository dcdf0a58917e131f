// SPDX-License-Identifier: MIT
// Ambient light and the area light's diffuse reflection, no further than shadows need: the light acts as from its centre
// (its share that a surface does not see is ψ), with the fall-off of a distance and, for rectangle and disk, of the
// emitter's own cosine. 4 texture reads a pixel. ATTENUATION: by how much a shadow may darken what is shown, instead.
#include "band.glsl"
#include "shared/view.glsl.h"
#include "lib/octahedral.glsl"

layout(std140, binding = 0) uniform Constants {
    ViewBlock view;
    mat4 lightFromWorld;
    vec4 colour_ambient; // the light's colour times its intensity, w = ambient
    vec4 shape_reach;    // x = shape (2: directional), y = distance at which the intensity holds [m], zw = size [m]
    vec4 exposure;       // x = factor on linear light before it is shown
};
uniform sampler2D depth;
uniform sampler2D normal;
uniform sampler2D colour;
#ifdef ATTENUATION
#include "lib/srgb.glsl"
uniform writeonly image2D attenuation;
#else
uniform sampler2D shadow;
uniform writeonly image2D lit;
#endif

const vec3 background = vec3(0.10, 0.11, 0.13);

void main()
{
    ivec2 pixel = texelHere().xy; // fetches and stores outside the picture do nothing
#ifdef ATTENUATION
    ivec2 surface = pixel;
#else
    ivec2 surface = pixel + (textureSize(depth, 0) - imageSize(lit)) / 2; // the geometry buffer may have a margin
#endif
    float d = texelFetch(depth, surface, 0).x;
    vec2 centre = vec2(surface) + 0.5;
    vec3 positionWorld = view.eyeWorld.xyz + d * (view.rayCorner.xyz + centre.x * view.rayDx.xyz + centre.y * view.rayDy.xyz);
    vec3 n = mat3(lightFromWorld) * unitFromOctahedral(texelFetch(normal, surface, 0).zw);
    vec3 l = -(lightFromWorld * vec4(positionWorld, 1.0)).xyz;

    // Half the light's size keeps the inverse square finite at the light itself.
    float distance2 = dot(l, l) + 0.25 * dot(shape_reach.zw, shape_reach.zw);
    vec3 direction = l * inversesqrt(max(dot(l, l), 1e-20));
    float area = max(dot(n, direction), 0.0) * max(direction.z, 0.0) * (shape_reach.y * shape_reach.y) / distance2;
    float irradiance = shape_reach.x == 2.0 ? max(n.z, 0.0) : area;

    // Ambient light is a little stronger from above, so that what lies in full shadow keeps its shape.
    float ambient = colour_ambient.w * (0.75 + 0.25 * dot(n, lightFromWorld[1].xyz));
    vec4 root_own = texelFetch(colour, surface, 0);
    vec3 base = root_own.rgb * root_own.rgb;
    vec3 direct = colour_ambient.rgb * irradiance;
#ifdef ATTENUATION
    vec3 dark = clamp(base * mix(vec3(ambient), vec3(1.0), root_own.a) * exposure.x, 0.0, 1.0);
    vec3 bright = clamp(base * mix(ambient + direct, vec3(1.0), root_own.a) * exposure.x, 0.0, 1.0);
    float red = srgbFromLinear(bright.r) - srgbFromLinear(dark.r);
    float green = srgbFromLinear(bright.g) - srgbFromLinear(dark.g);
    float blue = srgbFromLinear(bright.b) - srgbFromLinear(dark.b);
    imageStore(attenuation, pixel, vec4(d > 0.0 ? max(max(red, green), blue) : 0.0));
#else
    vec3 light = ambient + direct * (1.0 - texelFetch(shadow, pixel, 0).x);
    imageStore(lit, pixel, vec4(d > 0.0 ? base * mix(light, vec3(1.0), root_own.a) : background, 1.0));
#endif
}
