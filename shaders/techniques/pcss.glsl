// SPDX-License-Identifier: MIT
// Blocker search, then a filter as wide as the penumbra; see renderer/techniques/pcss.cpp.
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

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, true);
    vec2 shift = rotate != 0 ? pixelShift(vec2(r.pixel)) : vec2(0.0);
    vec2 halfLight = lightScale * lightView.light.xy;
    float f = lightView.sample_reference.z;
    vec2 texelsPerMetre = lightView.light.z / (2.0 * lightView.window.zw);
    // Never narrower than the texel itself: smaller filters only show its staircase.
    const vec2 smallest = vec2(1.0);

    vec2 search = max(penumbraHalfSize(halfLight, r.d, lightView.range.x, f, directional) * texelsPerMetre, smallest);
    float searchShare = 1.0 / float(searchTaps);
    float filterShare = 1.0 / float(filterTaps);
    int searched = r.known < 0.0 ? searchTaps : 0;
    float depths = 0.0;
    float blockers = 0.0;
    Taps t = firstTap(shift);
    for (int i = 0; i < searched; ++i) {
        t = nextTap(t, i, searchShare);
        #if SEARCH == SEARCH_CENTRED
        vec2 corner = floor(l.texel + search * t.offset * abs(t.offset));
#else
        vec2 corner = floor(l.texel + search * t.offset);
#endif
        float z = storedDepth(corner);
        float b = blocks(l, z, corner + 0.5 - l.texel);
        depths += b * z;
        blockers += b;
    }
    float d_b = max(axialDepth(depths / max(blockers, 1.0)), lightView.range.x);
    vec2 penumbra = max(penumbraHalfSize(halfLight, r.d, d_b, f, directional) * texelsPerMetre, smallest);
    int filtered = blockers > 0.0 ? filterTaps : 0;
    float sum = 0.0;
    t = firstTap(shift);
    for (int i = 0; i < filtered; ++i) {
        t = nextTap(t, i, filterShare);
        sum += blocksAt(l, l.texel + penumbra * t.offset);
    }
    writeShadow(r, sum * filterShare);
}
