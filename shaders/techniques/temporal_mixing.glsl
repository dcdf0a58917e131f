// SPDX-License-Identifier: MIT
// How much of what is shown the samples are, and whom the neighbours matter to. For shaders with the parameters of
// renderer/techniques/temporal.cpp.
#include "lib/temporal.glsl"

// The share of ψ̂ in what is shown; the rest is the neighbours'.
float sampledOf(History h)
{
#if ERROR == ERROR_CAUTIOUS
    float error = cautiousError(h);
#else
    float error = standardError(h);
#endif
#if MIXING == MIXING_THRESHOLD
    float sampled = sampledShare(error, threshold, threshold);
#else
    float sampled = sampledShare(error, sMin, max(sMin, sMax));
#endif
    return h.n < float(fewSamples) ? 0.0 : sampled;
}

// Where nothing is known to block there is no penumbra, and nothing to filter.
bool asksNeighbours(History h, float blocker) { return sampledOf(h) < 1.0 && blocker != 0.0; }
