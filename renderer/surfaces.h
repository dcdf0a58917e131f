// SPDX-License-Identifier: MIT
// The surfaces that receive shadows: those that a view sees, and layer by layer those that a directional light sees.
#pragma once

#include "renderer/scene/scene_state.h"
#include "renderer/shadow_map/shadow_map.h"

namespace penumbra {

// Appends the pass that works out vertices which skins and morph targets move, if there are any.
void poseVertices(Flow& flow, const SceneState& state, const Geometry* geometry);

struct Surfaces {
    GeometryBuffer buffer;
    Image colour;
};
Surfaces drawSurfaces(Flow& flow, const View& view, const SceneState& state, const Geometry* geometry,
                      const glm::mat4& lastClipFromWorld);

inline constexpr int mostLightLayers = 16;

// One pixel for every texel of a shadow map of the directional light, through its centre along the light's axis. Eye
// depth counts from before the nearest surface.
View lightsView(const LightViewBlock& map, std::span<const Occluder> occluders);

// The n-th surface of each pixel from the light on, for n = 0 ... layers − 1; eye depth 0 where there are fewer. Faces
// that their material culls do not count..
std::vector<GeometryBuffer> drawLightLayers(Flow& flow, const View& view, const SceneState& state,
                                            const Geometry* geometry, int layers);
std::string_view lightLayerName(int layer); // "layer-1" ...

} // namespace penumbra
