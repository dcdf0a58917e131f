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
    float psi = 0.0;
    int pairs = m.known ? 0 : (layers + 1) / 2;
    for (int pair = 0; pair < pairs; ++pair) {
        vec4 b = momentsAt(m.place, pair);
        vec4 own = slicesOf(m.depth, pair, count, overlap);
        float second = varianceBound(b.zw, own.z, least);
        psi = max(psi, varianceBound(b.xy, own.x, least));
        psi = max(psi, 2 * pair + 1 < layers ? second : 0.0);
    }
    writeMomentShadow(r, m, withoutBleeding(psi, bleedingReduction));
}
