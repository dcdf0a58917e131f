// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace penumbra {

// A perspective camera. Looks from eye to target; world units are metres.
struct Camera {
    glm::vec3 eye{0, 2, 6};
    glm::vec3 target{0, 0, 0};
    glm::vec3 up{0, 1, 0};
    float fovY = 45; // vertical field of view [degrees]

    bool operator==(const Camera&) const = default;
};

glm::mat4 eyeFromWorld(const Camera& camera);

// What a picture of `size` pixels sees. Eye depth runs along −Z of the eye's space. `near` and `far` [m] bound what is
// drawn; they come from the scene's bounds so that no setting can cut it.
struct View {
    glm::mat4 eyeFromWorld{1};
    // Clip depth z / w runs from 1 at the near plane to 0 at the far one: a float z-buffer is then about as precise far
    // away as it is near.
    glm::mat4 clipFromWorld{1};
    glm::vec3 eyeWorld{0};
    // A pixel's ray, scaled so that its eye depth is 1: worldFromDepth = eyeWorld + depth · (rayCorner + x·rayDx +
    // y·rayDy), (x, y) in pixels from the lower left corner of the picture, centres at ½.
    glm::vec3 rayCorner{0}, rayDx{0}, rayDy{0};
    // Of parallel rays, which rayDx and rayDy of 0 make: how far from pixel to pixel the ray begins beside eyeWorld,
    // which is the lower left corner's. 0 for a camera.
    glm::vec3 eyeDx{0}, eyeDy{0};
    float near = 0.1f, far = 100;
    glm::ivec2 size{1, 1};
    float tanHalfFovY = 1;
};

View makeView(const Camera& camera, glm::ivec2 size, float near, float far);

// The same picture with so many pixels more on each side: every pixel keeps its ray.
View grown(const View& view, glm::ivec2 margin);

} // namespace penumbra
