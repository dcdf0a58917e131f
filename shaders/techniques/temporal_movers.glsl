// SPDX-License-Identifier: MIT
// Whether something that moves takes light from a surface, be it from a part of the light: looks at N_b texels of the map
// within the cone from the surface to the whole light. A hard test from one point of it would find this out only where
// that point is hidden.
//
// Texture reads: depth, normal and N_b of the map.
#include "percentage_closer.glsl"

uniform writeonly image2D movers; // 1: something does

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, true);
    vec2 s = lightView.sample_reference.xy;
    vec2 g = texelsPerLight(r, lightView.range.x);
    vec2 search = max(lightView.light.xy * g, smallestFilter);
    float share = 1.0 / float(searchTaps);
    int taps = r.known < 0.0 ? searchTaps : 0;
    float found = 0.0;
    Taps t = firstTap(rotate != 0 ? pixelShift(vec2(r.pixel)) : vec2(0.0));
    for (int i = 0; i < taps; ++i) {
        t = nextTap(t, i, share);
        vec2 o = t.offset;
        vec2 corner = floor(l.texel + search * o - s * g * reach(o)); // as meanBlocker() in percentage_closer.glsl
        float z = signedDepth(corner);
        found = z < 0.0 ? max(found, blocks(l, abs(z), corner + 0.5 - l.texel)) : found;
    }
    imageStore(movers, r.pixel, vec4(found));
}
