// SPDX-License-Identifier: MIT
// Skins and morph targets: poses the vertices of one job per row of groups, after keeping where they were. Streams are
// arrays of floats, since three of them are not a vec3 here.
#include "lib/posing.glsl"

layout(local_size_x = 64) in;

struct Job { // GpuScene::PoseJob
    uint firstPosed, firstVertex, vertexCount;
    uint firstInfluence, influenceSets, firstJoint;
    uint firstDelta, morphTargets, firstWeight;
};
struct Influences { // of four joints, two 16-bit numbers a word
    uint joints01, joints23;
    float weights[4];
};
layout(std430, binding = 0) readonly buffer Jobs { Job jobs[]; };
layout(std430, binding = 1) buffer Positions { float positions[]; };
layout(std430, binding = 2) buffer Normals { float normals[]; };
layout(std430, binding = 3) writeonly buffer LastPositions { float lastPositions[]; };
layout(std430, binding = 4) readonly buffer AllInfluences { Influences influences[]; };
layout(std430, binding = 5) readonly buffer Deltas { float deltas[]; }; // position and normal, six numbers
layout(std430, binding = 6) readonly buffer Joints { Affine worldFromMesh[]; };
layout(std430, binding = 7) readonly buffer Weights { float morphWeights[]; };

void main()
{
    Job job = jobs[gl_WorkGroupID.y];
    uint v = gl_GlobalInvocationID.x;
    if (v >= job.vertexCount) return;
    uint from = 3u * (job.firstVertex + v);
    vec3 position = vec3(positions[from], positions[from + 1u], positions[from + 2u]);
    vec3 normal = vec3(normals[from], normals[from + 1u], normals[from + 2u]);

    for (uint t = 0u; t < job.morphTargets; ++t) {
        float weight = morphWeights[job.firstWeight + t];
        uint d = 6u * (job.firstDelta + t * job.vertexCount + v);
        position = withTarget(position, vec3(deltas[d], deltas[d + 1u], deltas[d + 2u]), weight);
        normal = withTarget(normal, vec3(deltas[d + 3u], deltas[d + 4u], deltas[d + 5u]), weight);
    }
    if (job.influenceSets > 0u) {
        Affine blended = Affine(vec4(0.0), vec4(0.0), vec4(0.0));
        for (uint s = 0u; s < job.influenceSets; ++s) {
            Influences pull = influences[job.firstInfluence + s * job.vertexCount + v];
            uint joints[4] = uint[4](pull.joints01 & 0xffffu, pull.joints01 >> 16, pull.joints23 & 0xffffu, pull.joints23 >> 16);
            for (int k = 0; k < 4; ++k)
                blended = withJoint(blended, worldFromMesh[job.firstJoint + joints[k]], pull.weights[k]);
        }
        position = transformed(blended, position);
        normal = transformedNormal(blended, normal);
    }
    uint to = 3u * (job.firstPosed + v);
#ifndef AGAIN // instead of the frame before: its last positions stay
    for (uint i = 0u; i < 3u; ++i) lastPositions[to + i] = positions[to + i];
#endif
    positions[to] = position.x;
    positions[to + 1u] = position.y;
    positions[to + 2u] = position.z;
    normals[to] = normal.x;
    normals[to + 1u] = normal.y;
    normals[to + 2u] = normal.z;
}
