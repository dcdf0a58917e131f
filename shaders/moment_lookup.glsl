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
    float depth; // of the receiver, biased, as the moments know depth
    bool known;  // ψ is: it does not hang on the map
    float psi;
};

// Behind the horizon of the light's centre all is dark; outside the map, and in one without depth, nothing casts.
MomentLookup findMoments(Receiver r, float constantBias, float slopeTexels)
{
    Lookup l = makeLookup(r, constantBias, slopeTexels, false, false);
    MomentLookup m;
    m.place = (l.texel + lookup.border_perTexel.x) * lookup.border_perTexel.y;
    m.depth = fma(l.compared - l.offset, lookup.depth_exponents.x, lookup.depth_exponents.y);
    bool below = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    bool outside = any(notEqual(m.place, clamp(m.place, 0.0, 1.0))) || !(abs(m.depth) < 1e30);
    m.known = below || outside;
    m.psi = below ? 1.0 : 0.0;
    return m;
}

vec4 momentsAt(vec2 place, int layer)
{
#ifdef LAYERED
    vec4 stored = textureLod(moments, vec3(place, layer), 0.0);
#else
    vec4 stored = textureLod(moments, place, 0.0);
#endif
    return lookup.momentsFromStored * stored + lookup.momentsOffset;
}
vec4 momentsAt(vec2 place) { return momentsAt(place, 0); }

// Of the texel so many beside the kernel's centre.
float kernelWeight(int i) { return lookup.weights[abs(i) >> 2][abs(i) & 3]; }

DepthRange mappedRange() { return DepthRange(lookup.range.x, lookup.range.y, lookup.range.z, lookup.range.w); }

void writeMomentShadow(Receiver r, MomentLookup m, float psi) { writeShadow(r, m.known ? m.psi : psi); }
