// SPDX-License-Identifier: MIT
#include "assets/make_scenes/scenes.h"

namespace make_scenes {

Stage::Stage(const std::string& name, const std::string& description, double halfFloor) : gltf(name, description) {
    const int floor = gltf.material({"floor", {0.7, 0.7, 0.7}});
    grey = gltf.material({"grey", {0.5, 0.5, 0.5}});
    red = gltf.material({"red", {0.65, 0.25, 0.18}});
    blue = gltf.material({"blue", {0.2, 0.35, 0.6}});
    gltf.object("floor", box({-halfFloor, -0.1, -halfFloor}, {halfFloor, 0, halfFloor}), floor);
}

Gltf twoBoxes() {
    Stage s("two-boxes",
            "Two boxes, one standing and one floating: the simplest scene with a contact shadow and a soft one.", 4);
    s.gltf.object("standing", box({-1.1, 0, -0.5}, {-0.3, 0.8, 0.3}), s.red);
    s.gltf.object("floating", box({0.3, 1, -0.2}, {0.9, 1.5, 0.5}), s.blue);
    s.gltf.camera({.eye = {2.5f, 3, 4}, .target = {0, 0.5f, 0}, .fovY = 45});
    s.gltf.light({.position = {0, 4, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

// --- those with closed forms: light at 10 m facing down, caster at 6 m, floor at 0 ----------------------------------

// V(x) = clamp((a + x (H − h)/h) / 2a) with a = ½, H = 10, h = 6, over |z| < 3: there no ray to the light passes the
// slab's other sides. It is no larger, so that a shadow map has its texels where the edge is.
Gltf halfPlane() {
    Stage s("half-plane", "A straight edge above a floor: its penumbra is known exactly, a ramp from light to dark.",
            6);
    s.gltf.object("slab", box({-5, 5.99, -5}, {0, 6, 5}), s.red);
    s.gltf.camera({.eye = {3, 3, 2.5f}, .target = {0, 0, 0}});
    s.gltf.light({.position = {0, 10, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

// V = 1 − overlap of the occluder [−0.6, 0.6] x [−0.4, 0.4], projected from the receiver, with the light.
Gltf rectangle() {
    Stage s("rectangle", "A plate above a floor: its shadow is known exactly, the overlap of two rectangles.", 10);
    s.gltf.object("plate", box({-0.6, 5.998, -0.4}, {0.6, 6, 0.4}), s.red);
    s.gltf.camera({.eye = {3, 4, 4}, .target = {0, 0, 0}});
    s.gltf.light({.position = {0, 10, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

// A ball of radius 0.6 under a disk of radius ½.
Gltf ball() {
    Stage s("sphere", "A ball under a disk-shaped light: its shadow is known exactly.", 10);
    s.gltf.object("ball", sphere({0, 6, 0}, 0.6, 256), s.red);
    s.gltf.camera({.eye = {3, 4, 4}, .target = {0, 0, 0}});
    s.gltf.light({.shape = penumbra::LightShape::Disk, .position = {0, 10, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

} // namespace make_scenes
