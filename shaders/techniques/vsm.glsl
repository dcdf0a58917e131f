// SPDX-License-Identifier: MIT
// Cantelli's bound on one filtered sample of depth and square; see renderer/techniques/vsm.cpp.
#include "moment_lookup.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    float unit = lookup.depth_exponents.x; // of depth, in depth ranges
    float psi = varianceBound(momentsAt(m).xy, m.depth, max(minimumVariance * unit * unit, 1e-12));
    writeMomentShadow(r, m, withoutBleeding(psi, bleedingReduction));
}
