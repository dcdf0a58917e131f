// SPDX-License-Identifier: MIT
// What skins and morph targets make of a mesh. The GPU does it with the same source (shaders/lib/posing.glsl); here it
// is for whoever needs the vertices themselves: bounds, floors, ray tracing, tests.
#pragma once

#include "renderer/scene/scene.h"

namespace penumbra {

// Whether a node's vertices change with the pose, beyond its matrix.
bool isSkinned(const Node& node, const Primitive& primitive);
bool isPosed(const Node& node, const Primitive& primitive);

// Whether it is drawn as a mirror shows it: triangles then turn the other way round. Of a skin all joints are mirrored
// or none is.
bool isMirrored(const Scene& scene, const Pose& pose, size_t node, const Primitive& primitive);

// Places what a node draws: its matrix, or the identity where joints place the vertices in the world.
const glm::mat4& worldFromModel(const Pose& pose, const Scene& scene, size_t node, const Primitive& primitive);

// World bounds of what a node draws of a primitive: exact for rigid boxes, else a box that holds it.
Bounds posedBounds(const Scene& scene, const Pose& pose, size_t node, const Primitive& primitive);

// The world positions of the primitive's vertices as the node draws them, `vertexCount` of them.
void posedPositions(const Scene& scene, const Pose& pose, size_t node, const Primitive& primitive,
                    std::vector<glm::vec3>& positionsWorld);

} // namespace penumbra
