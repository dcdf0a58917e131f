// SPDX-License-Identifier: MIT
// The whole frame as a list of passes. No OpenGL: a flow can be built, listed and tested without a GPU.
#pragma once

#include "renderer/core/flow.h"
#include "renderer/scene/scene_state.h"
#include "renderer/session.h"

namespace penumbra {

struct Frame {
    Image shadow;               // ψ
    std::optional<Image> rival; // ψ of technique B, where the picture compares two
    Image display;              // RGBA8, sRGB; twice as wide as the view where two stand side by side
    Image depth;                // of the surfaces seen, along the view axis [m]; 0: none. May have a margin
};

// Appends the passes of a session's frame to a flow that has begun. `geometry` may be null: the passes are listed all
// the same. `last` is null in a first frame.
Frame buildFrame(Flow& flow, const Session& session, const SceneState& state, const Geometry* geometry,
                 const LastFrame* last, const Inspection& inspection = {});

// A layer of what a directional light sees, and ψ there; see surfaces.h.
struct LightLayer {
    Image depth; // 0: no surface
    Image shadow;
};

// Appends the passes of the session's technique on the surfaces that its light sees, a pixel for each texel of a map of
// `size` texels along a side.
std::vector<LightLayer> buildLightLayers(Flow& flow, const Session& session, const SceneState& state,
                                         const Geometry* geometry, int size, int layers);

// The view of a session: near and far planes hold the whole scene.
View sessionView(const Session& session, const Bounds& bounds);

} // namespace penumbra
