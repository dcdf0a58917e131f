// SPDX-License-Identifier: MIT
#include "renderer/surfaces.h"

#include <algorithm>

namespace penumbra {
namespace {

constexpr Scope sceneScope{.instance = {}, .owner = "scene"};

constexpr Channel depthChannels[] = {{"depth", "d", "distance along the view axis; 0: no surface", Unit::Metres}};
constexpr Channel normalChannels[] = {{"geometric-x", "n", "geometric normal, world, octahedral", Unit::None, -1, 1},
                                      {"geometric-y", "n", "geometric normal, world, octahedral", Unit::None, -1, 1},
                                      {"shading-x", "n", "interpolated normal, world, octahedral", Unit::None, -1, 1},
                                      {"shading-y", "n", "interpolated normal, world, octahedral", Unit::None, -1, 1}};
constexpr Channel colourChannels[] = {
    {"red", "", "square root of the linear base colour", Unit::None, 0, 1},
    {"green", "", "square root of the linear base colour", Unit::None, 0, 1},
    {"blue", "", "square root of the linear base colour", Unit::None, 0, 1},
    {"own", "", "share of it that shines by itself: emissive or unlit", Unit::None, 0, 1}};
constexpr Channel motionChannels[] = {{"x", "", "last frame's place minus this frame's", Unit::Pixels},
                                      {"y", "", "last frame's place minus this frame's", Unit::Pixels},
                                      {"depth", "", "last frame's depth minus this frame's", Unit::Metres}};
constexpr Channel zChannels[] = {{"z", "", "the rasteriser's own depth; 1: near plane, 0: far plane"}};

struct GeometryConstants {
    ViewBlock view;
    mat4 lastClipFromWorld;
};

} // namespace

void poseVertices(Flow& flow, const SceneState& state, const Geometry* geometry) {
    if (!geometry || !state.posing()) return;
    PoseVertices work{"pose.glsl", geometry, state.poseVersion()};
    if (state.turn() == Turn::Again) work.defines.push_back({"AGAIN"});
    flow.pass(sceneScope, {.stage = Stage::Scene, .name = "pose", .work = work});
}

Surfaces drawSurfaces(Flow& flow, const View& view, const SceneState& state, const Geometry* geometry,
                      const glm::mat4& lastClipFromWorld) {
    const Extent extent{view.size.x, view.size.y};
    Draw draw{.shader = "geometry_buffer.glsl",
              .geometry = geometry,
              .poseVersion = state.poseVersion(),
              .faces = Faces::Shown,
              .textured = true,
              .reversedDepth = true};
    PassSpec pass{.stage = Stage::Scene,
                  .name = "geometry-buffer",
                  .writes = {{"depth", Format::R32F, extent, depthChannels},
                             {"normal", Format::RGBA16Snorm, extent, normalChannels},
                             {"colour", Format::RGBA8, extent, colourChannels}},
                  .constants = GeometryConstants{viewBlock(view), lastClipFromWorld}};
    draw.defines.push_back({"COLOUR", 2});
    if (state.moving()) { // a still scene's motion follows from the two views

        draw.defines.push_back({"MOTION", 3});
        pass.writes.push_back({"motion", Format::RGBA16F, extent, motionChannels});
    }
    pass.writes.push_back({"z-buffer", Format::Depth32F, extent, zChannels});
    pass.work = draw;
    const Flow::Outputs images = flow.pass(sceneScope, pass);
    return {{images[0], images[1], state.moving() ? std::optional(images[3]) : std::nullopt}, images[2]};
}

std::string_view lightLayerName(int layer) {
    static constexpr std::string_view names[mostLightLayers] = {
        "layer-1", "layer-2",  "layer-3",  "layer-4",  "layer-5",  "layer-6",  "layer-7",  "layer-8",
        "layer-9", "layer-10", "layer-11", "layer-12", "layer-13", "layer-14", "layer-15", "layer-16"};
    return names[layer];
}

View lightsView(const LightViewBlock& map, std::span<const Occluder> occluders) {
    ensure(map.sample_reference.w != 0 && vec2(map.sample_reference) == vec2(0), "a light's view of parallel rays");
    const mat4& fromWorld = map.lightFromWorld;
    float nearest = 1e30f, farthest = -1e30f;
    for (const Occluder& occluder : occluders)
        for (int i = 0; i < 8; ++i) {
            const Bounds& box = occluder.boundsWorld;
            const vec4 corner{i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                              i & 4 ? box.max.z : box.min.z, 1};
            const float d = -(fromWorld * corner).z;
            nearest = std::min(nearest, d), farthest = std::max(farthest, d);
        }
    if (nearest > farthest) nearest = 0, farthest = 1;
    const float slack = 0.01f * std::max(farthest - nearest, 1e-6f * std::abs(farthest)) + 1e-20f;
    const float eye = nearest - 2 * slack; // its plane, by axial depth

    const mat4 worldFromLight = glm::inverse(fromWorld);
    const vec2 centre(map.window.x, map.window.y), half(map.window.z, map.window.w);
    const float size = map.light.z;
    View view;
    view.size = glm::ivec2(static_cast<int>(size));
    view.near = slack;
    view.far = farthest + slack - eye;
    view.eyeWorld = glm::vec3(worldFromLight * vec4(centre - half, -eye, 1));
    view.eyeDx = glm::vec3(worldFromLight[0]) * (2 * half.x / size);
    view.eyeDy = glm::vec3(worldFromLight[1]) * (2 * half.y / size);
    view.rayCorner = -glm::vec3(worldFromLight[2]);
    view.eyeFromWorld = fromWorld;
    view.eyeFromWorld[3] = vec4(-(glm::mat3(fromWorld) * view.eyeWorld), 1);
    // clip = M · light-space position, row by row; z runs from 1 at the near plane to 0 at the far one.
    const float range = view.far - view.near;
    const mat4 rows{vec4(1 / half.x, 0, 0, -centre.x / half.x), vec4(0, 1 / half.y, 0, -centre.y / half.y),
                    vec4(0, 0, 1 / range, (view.far + eye) / range), vec4(0, 0, 0, 1)};
    view.clipFromWorld = glm::transpose(rows) * fromWorld;
    return view;
}

std::vector<GeometryBuffer> drawLightLayers(Flow& flow, const View& view, const SceneState& state,
                                            const Geometry* geometry, int layers) {
    ensure(layers <= mostLightLayers, "more layers than have names");
    const Extent extent{view.size.x, view.size.y};
    std::vector<GeometryBuffer> buffers;
    for (int layer = 0; layer < layers; ++layer) {
        Draw draw{.shader = "geometry_buffer.glsl",
                  .geometry = geometry,
                  .poseVersion = state.poseVersion(),
                  .faces = Faces::Shown,
                  .reversedDepth = true};
        draw.defines.push_back({"PARALLEL"});
        PassSpec pass{.stage = Stage::Scene,
                      .name = "geometry-buffer",
                      .writes = {{"depth", Format::R32F, extent, depthChannels},
                                 {"normal", Format::RGBA16Snorm, extent, normalChannels},
                                 {"z-buffer", Format::Depth32F, extent, zChannels}},
                      .constants = GeometryConstants{viewBlock(view), view.clipFromWorld}};
        if (layer > 0) {
            draw.defines.push_back({"PEELED"});
            pass.reads.push_back({"nearer", buffers.back().depth});
        }
        pass.work = draw;
        const Flow::Outputs images = flow.pass({.instance = lightLayerName(layer), .owner = "scene"}, pass);
        buffers.push_back({images[0], images[1], std::nullopt});
    }
    return buffers;
}

} // namespace penumbra
