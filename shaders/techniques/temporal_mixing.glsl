// SPDX-License-Identifier: MIT
// How much of what is shown the samples are, and whom the neighbours matter to. For shaders with the parameters of
// renderer/techniques/temporal.cpp.
#include "lib/temporal.glsl"

#ifdef GUIDED
uniform sampler2D attenuation; // by how much a shadow darkens what is shown, at most
#endif

// How much of an error of ψ at a texel of the buffer is to be seen, as far as it shall count.
float visibleAt(ivec2 texel)
{
#ifdef GUIDED
    return mix(1.0, texelFetch(attenuation, texel, 0).x, guided);
#else
    return 1.0;
#endif
}

// The share of ψ̂ in what is shown; the rest is the neighbours'.
float sampledOf(History h, float visible)
{
#if ERROR == ERROR_CAUTIOUS
    float error = cautiousError(h);
#else
    float error = standardError(h);
#endif
#if MIXING == MIXING_THRESHOLD
    float sampled = sampledShare(error * visible, threshold, threshold);
#else
    float sampled = sampledShare(error * visible, sMin, max(sMin, sMax));
#endif
    return h.n < float(fewSamples) * visible ? 0.0 : sampled;
}

// Where nothing is known to block there is no penumbra, and nothing to filter.
bool asksNeighbours(History h, float blocker, float visible) { return sampledOf(h, visible) < 1.0 && blocker != 0.0; }
