// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_state.h"

#include "renderer/scene/closed_surface.h"

namespace penumbra {

void SceneState::setScene(std::shared_ptr<const Scene> scene) {
    scene_ = std::move(scene);
    drawables_.clear();
    std::vector<std::vector<bool>> closed; // by mesh and primitive
    for (const Mesh& mesh : scene_->meshes) {
        closed.emplace_back();
        for (const Primitive& primitive : mesh.primitives)
            closed.back().push_back(!scene_->materials[static_cast<size_t>(primitive.material)].masked &&
                                    isClosedSurface(*scene_, primitive));
    }
    for (uint32_t n = 0; n < scene_->nodes.size(); ++n) {
        const Node& node = scene_->nodes[n];
        if (node.mesh < 0 || !node.visible) continue;
        const Mesh& mesh = scene_->meshes[static_cast<size_t>(node.mesh)];
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p)
            if (mesh.primitives[p].indexCount > 0)
                drawables_.push_back(
                    {n, static_cast<uint32_t>(node.mesh), p, closed[static_cast<size_t>(node.mesh)][p]});
    }
    pose_ = lastPose_ = Pose();
    ground_.reset();
    ++poseVersion_;
}

void SceneState::update(double seconds, bool ground) {
    const bool first = pose_.worldFromNode.size() != scene_->nodes.size();
    std::swap(lastPose_, pose_);
    evaluatePose(*scene_, seconds, pose_);
    if (first) lastPose_ = pose_;
    moving_ = !(pose_ == lastPose_);
    if (moving_ || ground != ground_.has_value()) ++poseVersion_;
    if (!moving_ && !first && ground == ground_.has_value()) return;

    occluders_.clear();
    bounds_ = Bounds();
    for (const Drawable& d : drawables_) {
        const Bounds& model = scene_->meshes[d.mesh].primitives[d.primitive].bounds;
        occluders_.push_back({transformed(model, pose_.worldFromNode[d.node]), true, d.closed});
        bounds_.add(occluders_.back().boundsWorld);
    }
    // The ground belongs to the scene's rest pose: it does not move with an animation.
    if (!ground) ground_.reset();
    if (ground && !ground_) ground_ = groundBelow(*scene_, pose_);
    if (ground_) {
        Bounds plane;
        const glm::vec2 low = ground_->centre - ground_->halfSize, high = ground_->centre + ground_->halfSize;
        plane.add({low.x, ground_->height, low.y});
        plane.add({high.x, ground_->height, high.y});
        occluders_.push_back({plane, false, false});
        bounds_.add(plane);
    }
}

} // namespace penumbra
