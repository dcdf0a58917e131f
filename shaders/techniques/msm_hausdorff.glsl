// SPDX-License-Identifier: MIT
// The bound for depths in the range on one filtered sample of a moment map; see renderer/techniques/msm_hausdorff.cpp.
#include "moment_lookup.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    writeMomentShadow(r, m, hausdorffBound(momentsAt(m), m.depth, mappedRange()));
}
