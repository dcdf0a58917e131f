// SPDX-License-Identifier: MIT
#include "renderer/scene/posing.h"

namespace penumbra {
namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function" // what only the GPU calls
namespace glsl {
using glm::cross;
using glm::dot;
using glm::vec3;
using glm::vec4;
#include "shaders/lib/posing.glsl"
} // namespace glsl
#pragma GCC diagnostic pop

glsl::Affine affine(const glm::mat4& m) {
    const glm::mat4 rows = glm::transpose(m);
    return {rows[0], rows[1], rows[2]};
}

const glm::mat4 identity(1);

} // namespace

bool isSkinned(const Node& node, const Primitive& primitive) { return node.skin >= 0 && primitive.influenceSets > 0; }

bool isPosed(const Node& node, const Primitive& primitive) {
    return isSkinned(node, primitive) || primitive.morphTargets > 0;
}

bool isMirrored(const Scene& scene, const Pose& pose, size_t node, const Primitive& primitive) {
    const Node& of = scene.nodes[node];
    const glm::mat4& placed = isSkinned(of, primitive)
                                  ? pose.worldFromMesh[scene.skins[static_cast<size_t>(of.skin)].firstMatrix]
                                  : pose.worldFromNode[node];
    return glm::determinant(glm::mat3(placed)) < 0;
}

const glm::mat4& worldFromModel(const Pose& pose, const Scene& scene, size_t node, const Primitive& primitive) {
    return isSkinned(scene.nodes[node], primitive) ? identity : pose.worldFromNode[node];
}

Bounds posedBounds(const Scene& scene, const Pose& pose, size_t nodeIndex, const Primitive& primitive) {
    const Node& node = scene.nodes[nodeIndex];
    glm::vec3 least(0), most(0); // that the targets add, each as far as any vertex goes with it
    for (uint32_t t = 0; t < primitive.morphTargets; ++t) {
        const float weight = pose.morphWeights[node.firstWeight + t];
        const Bounds& reach = primitive.morphBounds[t];
        least += weight * (weight < 0 ? reach.max : reach.min);
        most += weight * (weight < 0 ? reach.min : reach.max);
    }
    const auto grown = [&](const Bounds& box) { return Bounds{box.min + least, box.max + most}; };
    if (!isSkinned(node, primitive)) return transformed(grown(primitive.bounds), pose.worldFromNode[nodeIndex]);
    // A skinned vertex lies between the places that its joints would give it.
    Bounds bounds;
    for (const Primitive::JointBounds& pulled : primitive.jointBounds)
        bounds.add(transformed(grown(pulled.bounds),
                               pose.worldFromMesh[scene.skins[size_t(node.skin)].firstMatrix + pulled.joint]));
    return bounds;
}

void posedPositions(const Scene& scene, const Pose& pose, size_t nodeIndex, const Primitive& primitive,
                    std::vector<glm::vec3>& positionsWorld) {
    const Node& node = scene.nodes[nodeIndex];
    const bool skinned = isSkinned(node, primitive);
    const glsl::Affine worldFromNode = affine(pose.worldFromNode[nodeIndex]);
    const size_t count = primitive.vertexCount;
    positionsWorld.resize(count);
    for (size_t v = 0; v < count; ++v) {
        glm::vec3 p = scene.positions[primitive.firstVertex + v];
        for (uint32_t t = 0; t < primitive.morphTargets; ++t)
            p = glsl::withTarget(p, scene.morphDeltas[primitive.firstDelta + t * count + v].position,
                                 pose.morphWeights[node.firstWeight + t]);
        glsl::Affine blended = worldFromNode;
        if (skinned) {
            blended = {glm::vec4(0), glm::vec4(0), glm::vec4(0)};
            const glm::mat4* joints = pose.worldFromMesh.data() + scene.skins[size_t(node.skin)].firstMatrix;
            for (uint32_t s = 0; s < primitive.influenceSets; ++s) {
                const Influences& pull = scene.influences[primitive.firstInfluence + s * count + v];
                for (int k = 0; k < 4; ++k)
                    if (pull.weights[k] > 0)
                        blended = glsl::withJoint(blended, affine(joints[pull.joints[k]]), pull.weights[k]);
            }
        }
        positionsWorld[v] = glsl::transformed(blended, p);
    }
}

} // namespace penumbra
