// SPDX-License-Identifier: MIT
// Algorithm 3 on one filtered sample of a moment map; see renderer/techniques/msm_hamburger.cpp.
#include "moment_lookup.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    writeMomentShadow(r, m, hamburgerBound(momentsAt(m), m.depth, mappedRange()));
}
