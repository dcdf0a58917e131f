// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"

#include "renderer/core/error.h"
#include "renderer/scene/posing.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

glm::quat quaternion(const float* xyzw) {
    const glm::quat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    const float length = glm::length(q);
    return length > 0 ? q / length : glm::quat(1, 0, 0, 0);
}

// The channel's value at `time`, `width` numbers; before the first and after the last key it holds still.
void valueAt(const AnimationChannel& channel, float time, float* value) {
    using Interpolation = AnimationChannel::Interpolation;
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const size_t width = channel.width;
    const auto numbers = [&](size_t index) { return channel.values.data() + index * width; };
    const auto key = [&](size_t i) { return numbers(cubic ? 3 * i + 1 : i); };

    const std::vector<float>& times = channel.times;
    const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    const size_t previous = next == 0 ? 0 : next - 1;
    if (next == 0 || next == times.size() || channel.interpolation == Interpolation::Step) {
        std::copy_n(key(previous), width, value);
        return;
    }
    const float t_d = times[next] - times[previous];
    const float t = (time - times[previous]) / t_d;
    if (cubic) { // glTF 2.0 specification, appendix C.4
        const float t2 = t * t, t3 = t2 * t;
        const float *v0 = key(previous), *b0 = numbers(3 * previous + 2), *v1 = key(next), *a1 = numbers(3 * next);
        for (size_t i = 0; i < width; ++i)
            value[i] = (2 * t3 - 3 * t2 + 1) * v0[i] + t_d * (t3 - 2 * t2 + t) * b0[i] + (-2 * t3 + 3 * t2) * v1[i] +
                       t_d * (t3 - t2) * a1[i];
        return;
    }
    if (channel.path == AnimationChannel::Path::Rotation) {
        const glm::quat q = glm::slerp(quaternion(key(previous)), quaternion(key(next)), t);
        value[0] = q.x, value[1] = q.y, value[2] = q.z, value[3] = q.w;
        return;
    }
    for (size_t i = 0; i < width; ++i) value[i] = glm::mix(key(previous)[i], key(next)[i], t);
}

// Keys are usable numbers, but their products in a deep hierarchy may leave the range of float.
bool isUsable(const glm::mat4& matrix) {
    float largest = 0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) largest += std::abs(matrix[column][row]);
    return largest < 1e12f; // false for NaN
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

float leastAlpha(const Material& material) {
    if (material.alphaCutoff <= 0) return 0;
    return material.baseColour.a > 0 ? material.alphaCutoff / material.baseColour.a : std::numeric_limits<float>::max();
}

uint64_t Scene::triangleCount() const {
    uint64_t count = 0;
    for (const Node& node : nodes) {
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : meshes[size_t(node.mesh)].primitives) count += primitive.indexCount / 3;
    }
    return count;
}

size_t Scene::findClip(std::string_view wanted) const {
    const auto found =
        std::find_if(animations.begin(), animations.end(), [&](const Animation& a) { return a.name == wanted; });
    if (found != animations.end()) return size_t(found - animations.begin());
    std::vector<std::string_view> names;
    for (const Animation& animation : animations) names.push_back(animation.name);
    if (names.empty()) throw InputError(fmt::format("there is no clip '{}': {} has no animation", wanted, name));
    throw InputError(fmt::format("there is no clip '{}'{}; {} has {}", wanted, suggestion(wanted, names), name,
                                 fmt::join(names, ", ")));
}

void evaluatePose(const Scene& scene, size_t clipIndex, double seconds, Pose& pose) {
    using Path = AnimationChannel::Path;
    pose.worldFromNode.resize(scene.nodes.size());
    pose.morphWeights = scene.restWeights;

    const Animation* clip = clipIndex < scene.animations.size() ? &scene.animations[clipIndex] : nullptr;
    float time = 0;
    if (clip && clip->duration > 0) {
        const double duration = clip->duration;
        time = float(seconds - duration * std::floor(seconds / duration));
    }

    auto channel = clip ? clip->channels.begin() : std::vector<AnimationChannel>::const_iterator();
    const auto end =
        clip ? clip->channels.end() : channel; // channels are sorted by node, so both lists are walked once
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        glm::vec3 translation = node.translation, scale = node.scale;
        glm::quat rotation = node.rotation;
        for (; channel != end && size_t(channel->node) == i; ++channel) {
            if (channel->path == Path::Weights) {
                valueAt(*channel, time, pose.morphWeights.data() + node.firstWeight);
                continue;
            }
            float value[4];
            valueAt(*channel, time, value);
            switch (channel->path) {
            case Path::Translation: translation = {value[0], value[1], value[2]}; break;
            case Path::Rotation: rotation = quaternion(value); break;
            case Path::Scale: scale = {value[0], value[1], value[2]}; break;
            case Path::Weights: break;
            }
        }
        const glm::mat4 parentFromNode = node.matrix ? *node.matrix : matrixOf(translation, rotation, scale);
        glm::mat4& worldFromNode = pose.worldFromNode[i];
        worldFromNode = node.parent < 0 ? parentFromNode : pose.worldFromNode[size_t(node.parent)] * parentFromNode;
        if (clip && !isUsable(worldFromNode))
            worldFromNode = matrixOf(glm::vec3(0), glm::quat(1, 0, 0, 0), glm::vec3(0));
    }

    size_t joints = 0;
    for (const Skin& skin : scene.skins) joints += skin.joints.size();
    pose.worldFromMesh.resize(joints);
    for (const Skin& skin : scene.skins)
        for (size_t j = 0; j < skin.joints.size(); ++j)
            pose.worldFromMesh[skin.firstMatrix + j] =
                pose.worldFromNode[size_t(skin.joints[j])] * skin.jointFromMesh[j];
}

Bounds worldBounds(const Scene& scene, const Pose& pose) {
    Bounds bounds;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives)
            bounds.add(posedBounds(scene, pose, i, primitive));
    }
    return bounds;
}

} // namespace penumbra
