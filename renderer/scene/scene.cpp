// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

glm::quat quaternion(const glm::vec4& xyzw) {
    const float length = glm::length(xyzw);
    return length > 0 ? glm::quat(xyzw.w, xyzw.x, xyzw.y, xyzw.z) / length : glm::quat(1, 0, 0, 0);
}

glm::vec4 vector(const glm::quat& q) { return {q.x, q.y, q.z, q.w}; }

// The channel's value at `time`; before the first and after the last key it holds still.
glm::vec4 valueAt(const AnimationChannel& channel, float time) {
    using Interpolation = AnimationChannel::Interpolation;
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const auto key = [&](size_t i) { return channel.values[cubic ? 3 * i + 1 : i]; };
    const auto inTangent = [&](size_t i) { return channel.values[3 * i]; };
    const auto outTangent = [&](size_t i) { return channel.values[3 * i + 2]; };

    const std::vector<float>& times = channel.times;
    if (time <= times.front()) return key(0);
    if (time >= times.back()) return key(times.size() - 1);
    const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    const size_t previous = next - 1;
    if (channel.interpolation == Interpolation::Step) return key(previous);

    const float t_d = times[next] - times[previous];
    const float t = (time - times[previous]) / t_d;
    if (cubic) { // glTF 2.0 specification, appendix C.4
        const float t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * key(previous) + t_d * (t3 - 2 * t2 + t) * outTangent(previous) +
               (-2 * t3 + 3 * t2) * key(next) + t_d * (t3 - t2) * inTangent(next);
    }
    if (channel.path == AnimationChannel::Path::Rotation)
        return vector(glm::slerp(quaternion(key(previous)), quaternion(key(next)), t));
    return glm::mix(key(previous), key(next), t);
}

glm::mat4 matrixOf(const glm::vec3& translation, const glm::quat& rotation, const glm::vec3& scale) {
    glm::mat4 matrix = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
    matrix[3] = glm::vec4(translation, 1);
    return matrix;
}

} // namespace

Bounds transformed(const Bounds& bounds, const glm::mat4& matrix) {
    Bounds result;
    if (bounds.empty()) return result;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                          corner & 4 ? bounds.max.z : bounds.min.z);
        result.add(glm::vec3(matrix * glm::vec4(p, 1)));
    }
    return result;
}

uint64_t Scene::triangleCount() const {
    uint64_t count = 0;
    for (const Node& node : nodes) {
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : meshes[size_t(node.mesh)].primitives) count += primitive.indexCount / 3;
    }
    return count;
}

void evaluatePose(const Scene& scene, double seconds, Pose& pose) {
    pose.worldFromNode.resize(scene.nodes.size());

    const Animation* clip = scene.animations.empty() ? nullptr : &scene.animations.front();
    float time = 0;
    if (clip && clip->duration > 0) {
        const double duration = clip->duration;
        time = float(seconds - duration * std::floor(seconds / duration));
    }

    size_t channelIndex = 0; // channels are sorted by node, so both lists are walked once
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        glm::vec3 translation = node.translation, scale = node.scale;
        glm::quat rotation = node.rotation;
        for (; clip && channelIndex < clip->channels.size() && size_t(clip->channels[channelIndex].node) == i;
             ++channelIndex) {
            const AnimationChannel& channel = clip->channels[channelIndex];
            const glm::vec4 value = valueAt(channel, time);
            switch (channel.path) {
            case AnimationChannel::Path::Translation: translation = glm::vec3(value); break;
            case AnimationChannel::Path::Rotation: rotation = quaternion(value); break;
            case AnimationChannel::Path::Scale: scale = glm::vec3(value); break;
            }
        }
        const glm::mat4 parentFromNode = node.matrix ? *node.matrix : matrixOf(translation, rotation, scale);
        pose.worldFromNode[i] =
            node.parent < 0 ? parentFromNode : pose.worldFromNode[size_t(node.parent)] * parentFromNode;
    }
}

Bounds worldBounds(const Scene& scene, const Pose& pose) {
    Bounds bounds;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives)
            bounds.add(transformed(primitive.bounds, pose.worldFromNode[i]));
    }
    return bounds;
}

} // namespace penumbra
