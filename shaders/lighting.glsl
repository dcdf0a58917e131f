// SPDX-License-Identifier: MIT
// Ambient light and the area lights' diffuse reflection, no further than shadows need: a light acts as from its centre
// (its share that a surface does not see is ψ), with the fall-off of a distance and, for rectangle and disk, of the
// emitter's own cosine. 3 texture reads a pixel and one for each of LIGHTS. ATTENUATION: by how much a shadow may darken what is shown, instead.
#include "band.glsl"
#include "shared/view.glsl.h"
#include "lib/octahedral.glsl"

struct Light {
    mat4 lightFromWorld;
    vec4 colour;      // times its intensity
    vec4 shape_reach; // x = shape (2: directional), y = distance at which the intensity holds [m], zw = size [m]
};
layout(std140, binding = 0) uniform Constants {
    ViewBlock view;
    vec4 ambient_exposure; // x = ambient, y = factor on linear light before it is shown
    Light lights[LIGHTS];
};
uniform sampler2D depth;
uniform sampler2D normal;
uniform sampler2D colour;
#ifdef ATTENUATION
#include "lib/srgb.glsl"
uniform writeonly image2D attenuation;
#else
uniform sampler2D shadow0;
#if LIGHTS > 1
uniform sampler2D shadow1;
#endif
#if LIGHTS > 2
uniform sampler2D shadow2;
#endif
#if LIGHTS > 3
uniform sampler2D shadow3;
#endif
uniform writeonly image2D lit;
#endif

const vec3 background = vec3(0.10, 0.11, 0.13);

// What a white surface reflects of a light that nothing hides.
vec3 reflected(Light light, vec3 positionWorld, vec3 normalWorld)
{
    vec3 n = mat3(light.lightFromWorld) * normalWorld;
    vec3 l = -(light.lightFromWorld * vec4(positionWorld, 1.0)).xyz;
    // Half the light's size keeps the inverse square finite at the light itself.
    float distance2 = dot(l, l) + 0.25 * dot(light.shape_reach.zw, light.shape_reach.zw);
    vec3 direction = l * inversesqrt(max(dot(l, l), 1e-20));
    float reach2 = light.shape_reach.y * light.shape_reach.y;
    float area = max(dot(n, direction), 0.0) * max(direction.z, 0.0) * reach2 / distance2;
    return light.colour.rgb * (light.shape_reach.x == 2.0 ? max(n.z, 0.0) : area);
}

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
    vec3 normalWorld = unitFromOctahedral(texelFetch(normal, surface, 0).zw);

    // Ambient light is a little stronger from above, so that what lies in full shadow keeps its shape.
    float ambient = ambient_exposure.x * (0.75 + 0.25 * normalWorld.y);
    vec4 root_own = texelFetch(colour, surface, 0);
    vec3 base = root_own.rgb * root_own.rgb;
    vec3 direct = reflected(lights[0], positionWorld, normalWorld);
#ifdef ATTENUATION
    vec3 dark = clamp(base * mix(vec3(ambient), vec3(1.0), root_own.a) * ambient_exposure.y, 0.0, 1.0);
    vec3 bright = clamp(base * mix(ambient + direct, vec3(1.0), root_own.a) * ambient_exposure.y, 0.0, 1.0);
    float red = srgbFromLinear(bright.r) - srgbFromLinear(dark.r);
    float green = srgbFromLinear(bright.g) - srgbFromLinear(dark.g);
    float blue = srgbFromLinear(bright.b) - srgbFromLinear(dark.b);
    imageStore(attenuation, pixel, vec4(d > 0.0 ? max(max(red, green), blue) : 0.0));
#else
    vec3 light = ambient + direct * (1.0 - texelFetch(shadow0, pixel, 0).x);
#if LIGHTS > 1
    light += reflected(lights[1], positionWorld, normalWorld) * (1.0 - texelFetch(shadow1, pixel, 0).x);
#endif
#if LIGHTS > 2
    light += reflected(lights[2], positionWorld, normalWorld) * (1.0 - texelFetch(shadow2, pixel, 0).x);
#endif
#if LIGHTS > 3
    light += reflected(lights[3], positionWorld, normalWorld) * (1.0 - texelFetch(shadow3, pixel, 0).x);
#endif
    imageStore(lit, pixel, vec4(d > 0.0 ? base * mix(light, vec3(1.0), root_own.a) : background, 1.0));
#endif
}
