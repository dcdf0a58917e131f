// SPDX-License-Identifier: MIT
// Cantelli's bound in every slice of the depth range; see renderer/techniques/lvsm.cpp.
#include "moment_lookup.glsl"
#include "lib/slices.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    float count = float(layers);
    float perSlice = count / (1.0 + 2.0 * overlap); // of the depth range
    float least = max(minimumVariance * perSlice * perSlice, 1e-12);
    // A surface that a slice's far end cuts looks nearer than it is, and shadows itself: what lies about that end is left to
    // other slices.
    float psi = 0.0;
    int pairs = m.known ? 0 : (layers + 1) / 2;
    for (int pair = 0; pair < pairs; ++pair) {
        vec4 b = momentsAt(m, pair);
        vec4 own = slicesOf(m.depth, pair, count, overlap);
        vec2 bounds = vec2(varianceBound(b.xy, own.x, least), varianceBound(b.zw, own.z, least));
        vec2 beyond = vec2(m.depth * count) - vec2(2 * pair + 1, 2 * pair + 2); // the far ends, without the overlap
        bool first = beyond.x <= 0.0 || beyond.x > 2.0 * overlap;
        bool second = (beyond.y <= 0.0 || beyond.y > 2.0 * overlap) && 2 * pair + 1 < layers;
        psi = max(psi, max(first ? bounds.x : 0.0, second ? bounds.y : 0.0));
    }
    writeMomentShadow(r, m, withoutBleeding(psi, bleedingReduction));
}
