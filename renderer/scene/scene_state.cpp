// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_state.h"

#include "renderer/scene/posing.h"

#include <algorithm>

namespace penumbra {

void SceneState::setScene(std::shared_ptr<const Scene> scene) {
    scene_ = std::move(scene);
    drawables_.clear();
    for (uint32_t n = 0; n < scene_->nodes.size(); ++n) {
        const Node& node = scene_->nodes[n];
        if (node.mesh < 0 || !node.visible) continue;
        const Mesh& mesh = scene_->meshes[static_cast<size_t>(node.mesh)];
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p)
            if (mesh.primitives[p].indexCount > 0)
                drawables_.push_back({n, static_cast<uint32_t>(node.mesh), p, isPosed(node, mesh.primitives[p])});
    }
    ground_.reset();
    restart();
}

bool SceneState::moved(const Drawable& d) const {
    const Node& node = scene_->nodes[d.node];
    const Primitive& shown = primitive(d);
    const auto differ = [](const auto& now, const auto& before, size_t first, size_t count) {
        return !std::equal(now.begin() + static_cast<std::ptrdiff_t>(first),
                           now.begin() + static_cast<std::ptrdiff_t>(first + count),
                           before.begin() + static_cast<std::ptrdiff_t>(first));
    };
    if (differ(pose_.morphWeights, lastPose_.morphWeights, node.firstWeight, shown.morphTargets)) return true;
    if (!isSkinned(node, shown)) return differ(pose_.worldFromNode, lastPose_.worldFromNode, d.node, 1);
    const Skin& skin = scene_->skins[static_cast<size_t>(node.skin)];
    return differ(pose_.worldFromMesh, lastPose_.worldFromMesh, skin.firstMatrix, skin.joints.size());
}

void SceneState::update(size_t clip, double seconds, bool ground, Turn turn) {
    const bool first = !posed_, wasMoving = moving_, again = turn == Turn::Again && !first;
    // A scene without a clip has one pose, and a paused one keeps it.
    const bool still = !first && (scene_->animations.empty() || (clip == clip_ && seconds == seconds_));
    turn_ = again ? Turn::Again : Turn::Next;
    if (again && still && ground == ground_.has_value()) {
        posing_ = false; // as it is already
        return;
    }
    if (still) {
        if (wasMoving && !again) lastPose_ = pose_;
    } else {
        if (!again) std::swap(lastPose_, pose_);
        if (again) ++poseVersion_;
        evaluatePose(*scene_, clip, seconds, pose_);
        if (first) {
            lastPose_ = pose_;
            ++poseVersion_;
        }
    }
    posed_ = true;
    clip_ = clip;
    seconds_ = seconds;
    if (still && !wasMoving && ground == ground_.has_value()) {
        posing_ = false;
        return;
    }
    measure(ground);
    const bool anyPosed = std::any_of(drawables_.begin(), drawables_.end(), [](const Drawable& d) { return d.posed; });
    posing_ = anyPosed && (first || moving_ || wasMoving);
}

void SceneState::measure(bool ground) {
    moving_ = false;
    occluders_.clear();
    parts_.clear();
    bounds_ = Bounds();
    size_t parts = 0;
    for (const Drawable& d : drawables_) parts += primitive(d).parts.size();
    parts_.reserve(parts); // they stay where they are
    for (const Drawable& d : drawables_) {
        occluders_.push_back({.boundsWorld = posedBounds(*scene_, pose_, d.node, primitive(d)),
                              .closed = primitive(d).closed,
                              .shadesItself = primitive(d).shadesItself,
                              .moved = moved(d),
                              .object = 1 + static_cast<int>(d.node)});
        for (const Bounds& part : primitive(d).parts) parts_.push_back(transformed(part, pose_.worldFromNode[d.node]));
        occluders_.back().partsWorld = std::span(parts_).last(primitive(d).parts.size());
        moving_ = moving_ || occluders_.back().moved;
        bounds_.add(occluders_.back().boundsWorld);
    }
    if (moving_ || ground != ground_.has_value()) ++poseVersion_;
    // The ground belongs to the scene's rest pose: it does not move with an animation.
    if (!ground) ground_.reset();
    if (ground && !ground_) ground_ = groundBelow(*scene_, pose_);
    if (ground_) {
        Bounds plane;
        const glm::vec2 low = ground_->centre - ground_->halfSize, high = ground_->centre + ground_->halfSize;
        plane.add({low.x, ground_->height, low.y});
        plane.add({high.x, ground_->height, high.y});
        occluders_.push_back({.boundsWorld = plane, .casts = false});
        bounds_.add(plane);
    }
}

} // namespace penumbra
