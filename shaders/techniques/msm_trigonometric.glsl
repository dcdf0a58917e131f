// SPDX-License-Identifier: MIT
// The bound of two sines and cosines on one filtered sample; see renderer/techniques/msm_trigonometric.cpp.
#include "moment_lookup.glsl"
#include "lib/moments_trigonometric.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    writeMomentShadow(r, m, trigonometricBound(momentsAt(m), m.depth, lookup.range.w));
}
