// SPDX-License-Identifier: MIT
// What a surface without a history begins with: an estimate as it is seen from the light's centre. Runs over the tiles in
// which temporal.glsl has found such surfaces; their n is negative until then.
//
// Texture reads: depth, normal, and N_b + N_f of the map; 1 of the buffer.
#define OWN_CONSTANTS vec4 picture; // xy of its first pixel in the buffer
#include "percentage_closer.glsl"
#include "techniques/temporal_mixing.glsl"

#ifdef HALFS
layout(rgba16f) uniform image2D shadowBuffer;
#else
layout(rgba32f) uniform image2D shadowBuffer;
#endif
#ifdef FILTERED
TILE_SET(askingTiles, asking)
#endif

void main()
{
    Receiver r = findReceiver(normalOffset);
    vec4 own = imageLoad(shadowBuffer, r.pixel);
    bool fresh = own.y < 0.0;
    History h = History(own.x, abs(own.y));

    vec2 halfLight = lightView.light.xy;
    vec2 s = lightView.sample_reference.xy;
    vec2 shift = rotate != 0 ? pixelShift(vec2(r.pixel)) : vec2(0.0);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, true);
    int searched = fresh ? searchTaps : 0;
    float d_b = meanBlocker(r, l, halfLight, s, shift, searched, 1.0 / float(searchTaps), true);
    bool found = d_b > noBlocker;
#if START == START_PCSS
    int compared = fresh && found ? filterTaps : 0;
    float psi = filteredShadow(r, l, halfLight, s, d_b, shift, compared, 1.0 / float(filterTaps));
    h.rho = halfLight.x + halfLight.y > 0.0 ? h.n * psi : h.rho;
#endif
    float blocker = found ? d_b : own.w;
    ivec2 pixel = r.pixel - ivec2(picture.xy);
    if (fresh) {
        imageStore(shadowBuffer, r.pixel, vec4(h.rho, h.n, own.z, blocker));
        imageStore(shadow, pixel, vec4(clamp(estimated(h), 0.0, 1.0)));
    }
#ifdef FILTERED
    if (fresh && asksNeighbours(h, blocker, visibleAt(r.pixel))) MARK(asking, pixel)
#endif
}
