// SPDX-License-Identifier: MIT
// A filtered Fourier series of the comparison; see renderer/techniques/convolution.cpp.
#include "moment_lookup.glsl"
#include "lib/convolution.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    MomentLookup m = findMoments(r, depthBias, slopeBias);
    // range: what the receiver is moved by, and how visibility follows from the series.
    float t = clamp(m.depth - lookup.range.x, -1.0, 1.0);
    float series = 0.5;
    int layers = m.known ? 0 : (terms + 1) / 2;
    for (int layer = 0; layer < layers; ++layer)
        series += squareWaveAt(momentsAt(m, layer), t, layer, terms, attenuation);
    writeMomentShadow(r, m, 1.0 - clamp((series + lookup.range.y) * lookup.range.z, 0.0, 1.0));
}
