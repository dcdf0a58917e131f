// SPDX-License-Identifier: MIT
// The built-in scenes, each made anew.
#pragma once

#include "assets/make_scenes/gltf.h"

namespace make_scenes {

Gltf courtyard(); // the default

// One difficulty each.
Gltf overlappingOccluders();
Gltf largePenumbra();
Gltf contact();
Gltf elongated();
Gltf thinSlab();
Gltf slantingSlab();
Gltf twoDepths();
Gltf overStairs();
Gltf movingCaster();

// Plain ones, the last three with closed forms for their shadows.
Gltf twoBoxes();
Gltf halfPlane();
Gltf rectangle();
Gltf ball();

// A floor whose top is at y = 0, and the materials of the scenes that show one thing.
struct Stage {
    Gltf gltf;
    int grey, red, blue;

    Stage(const std::string& name, const std::string& description, double halfFloor);
};

} // namespace make_scenes
