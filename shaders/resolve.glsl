// SPDX-License-Identifier: MIT
// The front half of every pass that turns a geometry buffer and a shadow map into ψ: which surface a pixel shows, where
// it falls on the map, and how far a bias moves it. A technique's shader includes this and writes main().
#include "band.glsl"
#include "shared/view.glsl.h"
#include "lib/octahedral.glsl"
#include "lib/light_space.glsl"

// A shader that looks at MAPS maps turns to each in turn.
#ifdef MAPS
#define LIGHT_VIEW firstLightView
#else
#define LIGHT_VIEW lightView
#endif
layout(std140, binding = 0) uniform Constants {
    ViewBlock view;
    LightViewBlock LIGHT_VIEW;
#ifdef OWN_CONSTANTS
    OWN_CONSTANTS
#endif
#ifdef TABLE
    vec4 table[TABLE]; // a filter's own
#endif
};
#ifdef MAPS
LightViewBlock lightView = firstLightView;
#endif
uniform sampler2D depth;  // eye depth [m], 0: no surface
uniform sampler2D normal; // xy geometric normal, world, octahedral
uniform writeonly image2D shadow;

// From a pixel of the image that is written to its texel of the geometry buffer.
ivec2 surfaceTexel(ivec2 pixel) { return pixel + ivec2(view.rayDx.w, view.rayDy.w); }

// Defines, not flags: software renderers run both sides of a branch.
const bool directional = DIRECTIONAL != 0;
const bool roundLight = ROUND != 0; // a disk, or directional

// A surface point in the coordinates of the shadow map.
struct Receiver {
    ivec2 pixel;        // of the image that is written
    float eyeDepth;     // [m], 0 without a surface
    vec3 ray;           // of the pixel, world, to eye depth 1 [m]
    vec3 normalWorld;   // unit, geometric, towards the viewer
    float known;        // ψ where it is known without a look at the map, else −1
    vec3 positionLight; // [m]
    vec3 normalLight;   // unit, geometric, towards the viewer
    float facing;       // n·(P − S) [m], or n·l for a directional light; see lib/light_space.glsl
    float d;            // axial depth [m]
    vec2 reference;     // place on the reference plane [m]
};

// ψ = 1 where the light's every point is below the surface's horizon.
bool lightBelowHorizon(vec3 positionLight, vec3 n)
{
    vec2 s = lightView.light.xy;
    float spread = roundLight ? length(n.xy * s) : dot(abs(n.xy), s); // disk or rectangle
    return directional ? n.z + spread <= 0.0 : spread - dot(n, positionLight) <= 0.0;
}

// What of a receiver depends on the point s of the light alone.
void lookFrom(vec2 s, inout Receiver r)
{
    r.reference = referenceFromLight(vec3(r.positionLight.xy, -r.d), s, lightView.sample_reference.z, directional);
    r.facing = directional ? dot(r.normalLight, vec3(s, 1.0)) : dot(r.normalLight, r.positionLight - vec3(s, 0.0));
}

// The pixel's receiver, moved along its normal by `normalOffset` texels. ψ is known to be 0 without a surface and behind
// the light, 1 with the light below the horizon. There are no early returns here: a software renderer runs both sides of
// every branch, and only loops of no rounds save it work. Fetches and stores outside the picture do nothing.
Receiver findReceiverOf(ivec2 pixel, float normalOffset)
{
    Receiver r;
    r.pixel = pixel;
    ivec2 texel = surfaceTexel(r.pixel);
    r.eyeDepth = texelFetch(depth, texel, 0).x;
    vec2 centre = vec2(texel) + 0.5;
    r.ray = view.rayCorner.xyz + centre.x * view.rayDx.xyz + centre.y * view.rayDy.xyz;
    vec3 eye = view.eyeWorld.xyz + centre.x * view.eyeDx.xyz + centre.y * view.eyeDy.xyz;
    vec3 positionWorld = eye + r.eyeDepth * r.ray;
    r.normalWorld = unitFromOctahedral(texelFetch(normal, texel, 0).xy);

    r.positionLight = (lightView.lightFromWorld * vec4(positionWorld, 1.0)).xyz;
    r.normalLight = mat3(lightView.lightFromWorld) * r.normalWorld;
    bool below = lightBelowHorizon(r.positionLight, r.normalLight);

    vec2 s = lightView.sample_reference.xy;
    float f = lightView.sample_reference.z;
    float texelSize = 2.0 * max(lightView.window.z, lightView.window.w) * lightView.light.w; // on the reference plane [m]
    // (R + ½) √2 w sin θ removes acne from planes at every angle and never diverges.
    vec3 towardsLight = normalize(directional ? vec3(s, 1.0) : vec3(s, 0.0) - r.positionLight);
    float cosine = dot(r.normalLight, towardsLight);
    float texelHere = directional ? texelSize : texelSize * max(-r.positionLight.z, 0.0) / f;
    r.positionLight += r.normalLight * (normalOffset * texelHere * sqrt(max(1.0 - cosine * cosine, 0.0)));

    bool behind = !directional && r.positionLight.z >= 0.0;
    r.d = behind ? f : -r.positionLight.z;
    lookFrom(s, r);
    r.known = r.eyeDepth <= 0.0 || (behind && !below) ? 0.0 : below ? 1.0 : -1.0;
    return r;
}

#ifdef AT_ALL_DEPTHS
// All invocations look at one pixel's receiver, each as if it lay at another depth; see shadow_lookup.glsl.
uniform sampler2D kernelDepths;
uniform writeonly image2D kernelOwn;

Receiver findReceiver(float normalOffset) { return findReceiverOf(lookup.probed.xy, normalOffset); }
void writeShadow(Receiver r, float psi) { imageStore(kernelOwn, texelHere().xy, vec4(r.known >= 0.0 ? r.known : psi)); }
#else
Receiver findReceiver(float normalOffset) { return findReceiverOf(texelHere().xy, normalOffset); }
void writeShadow(Receiver r, float psi) { imageStore(shadow, r.pixel, vec4(r.known >= 0.0 ? r.known : psi)); }
#endif
