// SPDX-License-Identifier: MIT
// One filtered lookup in a moment map. The shader of a technique includes this and turns moments into ψ.
#include "shared/moments.glsl.h"
#define OWN_CONSTANTS MomentLookupBlock lookup;
#include "shadow_lookup.glsl"
#include "lib/moments.glsl"

#ifdef LAYERED
uniform sampler2DArray moments;
#else
uniform sampler2D moments;
#endif

struct MomentLookup {
    vec2 place;  // of the receiver, in texture coordinates of the map
    vec2 stepX;  // its change from a pixel to the next, in a row
    vec2 stepY;  // and in a column
    float depth; // of the receiver, biased, as the moments know depth
    bool known;  // ψ is: it does not hang on the map
    float psi;
};

// Of a step in the world at the receiver, on the reference plane [m].
vec2 referenceStep(Receiver r, vec3 stepWorld)
{
    vec3 step = mat3(lightView.lightFromWorld) * stepWorld;
    return referenceStep(vec3(r.positionLight.xy, -r.d), step, lightView.sample_reference.xy, lightView.sample_reference.z,
                         directional);
}

// Behind the horizon of the light's centre all is dark; outside the map, and in one without depth, nothing casts.
MomentLookup findMoments(Receiver r, float constantBias, float slopeTexels)
{
    Lookup l = atProbedDepth(makeLookup(r, constantBias, slopeTexels, false, false));
    MomentLookup m;
    m.place = (l.texel + lookup.border_perTexel.x) * lookup.border_perTexel.y;
#ifdef MIPMAPPED
    // Compute shaders have no derivatives: where the neighbours' rays meet the receiver's plane.
    vec3 stepX = stepAlongPlane(view.eyeDx.xyz, view.rayDx.xyz, r.eyeDepth, r.ray, r.normalWorld);
    vec3 stepY = stepAlongPlane(view.eyeDy.xyz, view.rayDy.xyz, r.eyeDepth, r.ray, r.normalWorld);
    vec2 perMetre = lightView.light.z * lookup.border_perTexel.y / (2.0 * lightView.window.zw);
    m.stepX = referenceStep(r, stepX) * perMetre;
    m.stepY = referenceStep(r, stepY) * perMetre;
#else
    m.stepX = m.stepY = vec2(0.0);
#endif
    m.depth = fma(l.compared - l.offset, lookup.depth_exponents.x, lookup.depth_exponents.y);
    bool below = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    bool outside = any(notEqual(m.place, clamp(m.place, 0.0, 1.0))) || !(abs(m.depth) < 1e30);
    m.known = below || outside;
    m.psi = below ? 1.0 : 0.0;
    return m;
}

vec4 momentsAt(MomentLookup m, int layer)
{
#ifdef LAYERED
    vec3 place = vec3(m.place, layer);
#else
    vec2 place = m.place;
#endif
#ifdef MIPMAPPED
    vec4 stored = textureGrad(moments, place, m.stepX, m.stepY);
#else
    vec4 stored = textureLod(moments, place, 0.0);
#endif
    return lookup.momentsFromStored * stored + lookup.momentsOffset;
}
vec4 momentsAt(MomentLookup m) { return momentsAt(m, 0); }

// Of the texel so many beside the kernel's centre.
float kernelWeight(int i) { return lookup.weights[abs(i) >> 2][abs(i) & 3]; }

// Of the texel so many beside the lower left one of the four that a bilinear lookup reads, `share` of a texel before its place.
float bilinearWeight(int i, int half_n, float share)
{
    float own = abs(i) <= half_n ? kernelWeight(i) : 0.0;
    float next = abs(i - 1) <= half_n ? kernelWeight(i - 1) : 0.0;
    return mix(own, next, share);
}

DepthRange mappedRange() { return DepthRange(lookup.range.x, lookup.range.y, lookup.range.z, lookup.range.w); }

void writeMomentShadow(Receiver r, MomentLookup m, float psi) { writeShadow(r, m.known ? m.psi : psi); }
