// SPDX-License-Identifier: MIT
// A scene at one moment: poses, what moves, and the boxes that shadow maps and views are fitted to. No OpenGL.
#pragma once

#include "renderer/inputs.h"
#include "renderer/scene/scene.h"

#include <vector>

namespace penumbra {

// A primitive of a mesh, drawn by a node.
struct Drawable {
    uint32_t node, mesh, primitive;
    bool closed; // a closed surface without holes in its material
};

class SceneState {
public:
    void setScene(std::shared_ptr<const Scene> scene);
    // Poses the scene for a frame. `ground` adds the plane below it. "Moves" means that a node's matrix differs from
    // the one of the update before; the first update after setScene moves nothing.
    void update(double seconds, bool ground);

    const Scene* scene() const { return scene_.get(); }
    const Pose& pose() const { return pose_; }
    const Pose& lastPose() const { return lastPose_; }
    bool moving() const { return moving_; }
    uint64_t poseVersion() const { return poseVersion_; } // another number whenever a vertex has moved or appeared
    const std::vector<Drawable>& drawables() const { return drawables_; }
    const std::vector<Occluder>& occluders() const {
        return occluders_;
    } // one per drawable, then the ground if there is
    const std::optional<Ground>& ground() const { return ground_; }
    const Bounds& bounds() const { return bounds_; } // world, with the ground

private:
    std::shared_ptr<const Scene> scene_;
    Pose pose_, lastPose_;
    bool moving_ = false;
    uint64_t poseVersion_ = 0;
    std::vector<Drawable> drawables_;
    std::vector<Occluder> occluders_;
    std::optional<Ground> ground_;
    Bounds bounds_;
};

} // namespace penumbra
