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
    bool posed; // by a skin or morph targets: it has vertices of its own
};

class SceneState {
public:
    void setScene(std::shared_ptr<const Scene> scene);
    // Poses the scene for a frame. `ground` adds the plane below it. A thing "moves" if its matrix, joints or morph
    // weights differ from those of the update before; the first update after setScene or restart moves nothing. Again:
    // instead of that update.
    void update(size_t clip, double seconds, bool ground, Turn turn = Turn::Next);
    void restart() { posed_ = false; }

    const Scene* scene() const { return scene_.get(); }
    const Pose& pose() const { return pose_; }
    const Pose& lastPose() const { return lastPose_; }
    bool moving() const { return moving_; }
    // Whether skins or morph targets must be worked out for this frame: after a movement once more, for the motion.
    bool posing() const { return posing_; }
    Turn turn() const { return turn_; } // of the last update
    const Primitive& primitive(const Drawable& d) const { return scene_->meshes[d.mesh].primitives[d.primitive]; }
    uint64_t poseVersion() const { return poseVersion_; } // another number whenever a vertex has moved or appeared
    const std::vector<Drawable>& drawables() const { return drawables_; }
    // One per drawable, then the ground if there is.
    const std::vector<Occluder>& occluders() const { return occluders_; }
    const std::optional<Ground>& ground() const { return ground_; }
    const Bounds& bounds() const { return bounds_; } // world, with the ground

private:
    bool moved(const Drawable& drawable) const;
    void measure(bool ground);

    std::shared_ptr<const Scene> scene_;
    Pose pose_, lastPose_;
    size_t clip_ = 0;
    double seconds_ = 0;
    bool posed_ = false; // pose_ is that of the update before
    bool moving_ = false, posing_ = false;
    Turn turn_ = Turn::Next;
    uint64_t poseVersion_ = 0;
    std::vector<Drawable> drawables_;
    std::vector<Occluder> occluders_;
    std::vector<Bounds> parts_; // of the occluders
    std::optional<Ground> ground_;
    Bounds bounds_;
};

} // namespace penumbra
