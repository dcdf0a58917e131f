// SPDX-License-Identifier: MIT
// The truth by light-source sampling: the technique of that name with many maps. It shares the rasteriser with the
// techniques, and nothing with the rays.
#pragma once

#include "renderer/truth/truth.h"

namespace penumbra {

struct SamplingSettings {
    int maps = 1024;
    int mapSize = 2048; // texels along a side
};

// Draws the session's view. Standard errors are 0: the points are the same for every pixel, and their error is not a
// random one. The session and its techniques are as they were afterwards; the renderer has drawn other frames.
Truth sampledTruth(Renderer& renderer, Session& session, const SamplingSettings& settings);

// Where the two truths differ, it is by the bias and the resolution of shadow maps: the root mean square of their
// difference over the pixels that face the whole light.
double mapBias(const Truth& traced, const Truth& sampled);

} // namespace penumbra
