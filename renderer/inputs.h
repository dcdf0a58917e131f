// SPDX-License-Identifier: MIT
// What a technique is given for one light and one view.
#pragma once

#include "renderer/core/fixed_vector.h"
#include "renderer/core/flow.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

#include <optional>

namespace penumbra {

// The surfaces that receive shadows, seen from the camera (or from elsewhere: a technique must not assume the camera).
struct GeometryBuffer {
    Image depth;  // R32F: eye depth [m], 0 where there is no surface
    Image normal; // RGBA16Snorm: xy geometric, zw shading normal, world space, octahedral
    // RGBA16F: last frame's position minus this one's, xy [pixels] and z eye depth [m]; only when something moves.
    std::optional<Image> motion;
};

// One drawable's box, for fitting shadow maps.
struct Occluder {
    Bounds boundsWorld;
    bool casts = true;
    bool closed = false;                     // a closed surface; see scene/closed_surface.h
    bool shadesItself = true;                // see scene/closed_surface.h
    bool moved = false;                      // its pose differs from the last frame's
    int object = 0;                          // the number of the thing that it is part of, from 1; 0: of none
    std::span<const Bounds> partsWorld = {}; // that hold it more closely; empty: only boundsWorld does
};

// What the frame before was drawn with.
struct LastFrame {
    View view; // without a margin
    AreaLight light;
    FixedVector<FurtherLight, mostFurtherLights> furtherLights = {};
};

// What somebody looks into besides the picture, which is the same whether or not.
struct Inspection {
    bool images = false;             // techniques also write images that only explain
    std::optional<glm::ivec2> probe; // a pixel of the picture, from its lower left corner, that is looked at closely
    bool operator==(const Inspection&) const = default;
};

// What of a surface's look is not the shadow's.
struct Shading {
    Image colour;   // base colour, as the geometry buffer's pass writes it
    float ambient;  // light from everywhere
    float exposure; // [stops]
};

struct Inputs {
    const View& view; // of the geometry buffer: the picture with Technique::margin() around it
    const AreaLight& light;
    GeometryBuffer geometryBuffer;
    const Geometry* geometry; // what casts; null in an empty scene
    uint64_t poseVersion;     // changes when a vertex moved
    std::span<const Occluder> occluders;
    uint32_t frame; // index of the frame since the last reset, for sequences
    uint32_t seed;
    bool progressive = false;             // the frame may show a part of the work; later ones do the rest
    glm::ivec2 margin{0, 0};              // of the view [pixels]
    const LastFrame* last = nullptr;      // null: this is the first
    const AreaLight* lastLight = nullptr; // this light in the last frame; null: it did not shine
    Inspection inspection = {};
    const Shading* shading = nullptr; // how it is shown, if it is

    glm::ivec2 pictureSize() const { return view.size - 2 * margin; }
};

} // namespace penumbra
