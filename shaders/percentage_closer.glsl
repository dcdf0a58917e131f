// SPDX-License-Identifier: MIT
// The estimate of percentage-closer soft shadows (Fernando 2005): a blocker search, then a filter as wide as the penumbra.
// Both look at the light as it is seen from the receiver, whichever of its points s the map was drawn from: with blockers
// at depth d_b the light of half size r around its centre covers, on the reference plane and relative to the receiver,
//     g (r o − s),  o in [−1, 1]²,  g = f (1/d_b − 1/d_r) or, directional, d_r − d_b
// so that what is estimated is seen from the light's centre, and does not jump with s.
#include "shadow_lookup.glsl"
#include "lib/sampling.glsl"

// Walks the taps of a region: the square [−1, 1]² or, for round lights, the disk in it.
struct Taps {
    vec2 state;
    vec2 offset;
};

Taps firstTap(vec2 shift)
{
#if ROUND
    float angle = 6.2831853 * shift.x;
    return Taps(vec2(cos(angle), sin(angle)), vec2(0.0));
#else
    return Taps(shift, vec2(0.0));
#endif
}

Taps nextTap(Taps t, int i, float share)
{
#if ROUND
    t.state = spiralNext(t.state);
    t.offset = spiralPoint(t.state, i, share);
#else
    t.state = latticeNext(t.state, share);
    t.offset = 2.0 * t.state - 1.0;
#endif
    return t;
}

// How far out a tap of the region lies, in [0, 1].
float reach(vec2 offset) { return roundLight ? length(offset) : max(abs(offset.x), abs(offset.y)); }

// Never narrower than the texel itself: smaller filters only show its staircase.
const vec2 smallestFilter = vec2(1.0);

// g in texels, with what blocks at the axial depth d_b.
vec2 texelsPerLight(Receiver r, float d_b)
{
    float f = lightView.sample_reference.z;
    return penumbraHalfSize(vec2(1.0), r.d, d_b, f, directional) * (lightView.light.z / (2.0 * lightView.window.zw));
}

// The mean axial depth of `taps` texels that block, looked for over all depths; below the nearest depth: none does.
// `s` is the map's point of the light. With `centred` the taps are denser towards the receiver's own place.
const float noBlocker = -1e30;
float meanBlocker(Receiver r, Lookup l, vec2 halfLight, vec2 s, vec2 shift, int taps, float share, bool centred)
{
    vec2 g = texelsPerLight(r, lightView.range.x);
    vec2 search = max(halfLight * g, smallestFilter);
    float depths = 0.0;
    float blockers = 0.0;
    Taps t = firstTap(shift);
    for (int i = 0; i < taps; ++i) {
        t = nextTap(t, i, share);
        vec2 o = centred ? t.offset * abs(t.offset) : t.offset;
        // A blocker nearer to the receiver has a smaller g: the region is a cone of them, shifted as they grow.
        vec2 corner = floor(l.texel + search * o - s * g * reach(o));
        float z = storedDepth(corner);
        float b = blocks(l, z, corner + 0.5 - l.texel);
        depths += b * z;
        blockers += b;
    }
    return blockers > 0.0 ? max(axialDepth(depths / blockers), lightView.range.x) : noBlocker;
}

// The share of `taps` texels that block over the penumbra of a blocker at depth d_b.
float filteredShadow(Receiver r, Lookup l, vec2 halfLight, vec2 s, float d_b, vec2 shift, int taps, float share)
{
    vec2 g = texelsPerLight(r, d_b);
    vec2 penumbra = max(halfLight * g, smallestFilter);
    vec2 centre = l.texel - s * g;
    float sum = 0.0;
    Taps t = firstTap(shift);
    for (int i = 0; i < taps; ++i) {
        t = nextTap(t, i, share);
        sum += blocksAt(l, centre + penumbra * t.offset);
    }
    return sum * share;
}
