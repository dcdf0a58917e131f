// SPDX-License-Identifier: MIT
// A camera on its way, for measurements that must be repeatable: where it is at each step of 1/60 s.
#pragma once

#include "renderer/scene/camera.h"

#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

class CameraPath {
public:
    static constexpr double step = 1.0 / 60; // [s]

    struct Key {
        double seconds; // since the start, increasing
        Camera camera;
    };
    // Straight from key to key. At least one.
    explicit CameraPath(std::vector<Key> keys);

    // Once around the target, about its vertical, a degree a step.
    static CameraPath orbit(const Camera& start);
    // Forwards on the level for half of the distance to the target in 4 s, while the gaze turns 15 degrees to the
    // left and to the right.
    static CameraPath walk(const Camera& start);
    // Lines of T,X,Y,Z,TX,TY,TZ[,FOV]: seconds, eye and target in metres, vertical field of view in degrees; blank ones
    // and those that start with # are left out. Without FOV it is that of `start`. Throws InputError with the line.
    static CameraPath parse(std::string_view text, const Camera& start);

    int frames() const; // steps, both ends included
    Camera at(int frame) const;

private:
    std::vector<Key> keys_;
};

} // namespace penumbra
