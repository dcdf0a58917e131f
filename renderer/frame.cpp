// SPDX-License-Identifier: MIT
#include "renderer/frame.h"

#include "renderer/shadow_map/shadow_map.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr Scope sceneScope{.instance = {}, .owner = "scene"};
constexpr Scope frameScope{};

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
                                      {"y", "", "last frame's place minus this frame's", Unit::Pixels}};
constexpr Channel zChannels[] = {{"z", "", "the rasteriser's own depth; 1: near plane, 0: far plane"}};
constexpr Channel litChannels[] = {{"red", "", "reflected light, linear"},
                                   {"green", "", "reflected light, linear"},
                                   {"blue", "", "reflected light, linear"}};
constexpr Channel displayChannels[] = {{"red", "", "as shown, sRGB", Unit::None, 0, 1},
                                       {"green", "", "as shown, sRGB", Unit::None, 0, 1},
                                       {"blue", "", "as shown, sRGB", Unit::None, 0, 1}};

struct GeometryConstants {
    ViewBlock view;
    mat4 lastClipFromWorld;
};

struct LightingConstants {
    ViewBlock view;
    mat4 lightFromWorld;
    vec4 colour_ambient; // light's colour · intensity, w = ambient
    vec4 shape_reach;    // x = LightShape, y = distance at which intensity holds [m], zw = size of the light [m]
};

struct DisplayConstants {
    vec4 exposure_show; // x = factor, y = Show
};

// Passes of the scene's own: vertices that skins and morph targets move.
void pose(Flow& flow, const SceneState& state, const Geometry* geometry) {
    if (!geometry || !state.posing()) return;
    flow.pass(
        sceneScope,
        {.stage = Stage::Scene, .name = "pose", .work = PoseVertices{"pose.glsl", geometry, state.poseVersion()}});
}

struct Surfaces {
    GeometryBuffer buffer;
    Image colour;
};

Surfaces drawSurfaces(Flow& flow, const View& view, const SceneState& state, const Geometry* geometry,
                      const glm::mat4& lastClipFromWorld) {
    const Extent extent{view.size.x, view.size.y};
    Draw draw{.shader = "geometry_buffer.glsl",
              .geometry = geometry,
              .poseVersion = state.poseVersion(),
              .faces = Faces::AsMaterial,
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
        pass.writes.push_back({"motion", Format::RG16F, extent, motionChannels});
    }
    pass.writes.push_back({"z-buffer", Format::Depth32F, extent, zChannels});
    pass.work = draw;
    const Flow::Outputs images = flow.pass(sceneScope, pass);
    return {{images[0], images[1], state.moving() ? std::optional(images[3]) : std::nullopt}, images[2]};
}

Image shade(Flow& flow, const Session& session, const View& view, const Surfaces& surfaces, Image shadow) {
    const AreaLight& light = session.light;
    const LightingConstants constants{
        viewBlock(view), lightFromWorld(light), vec4(light.colour * light.intensity, session.display.ambient),
        vec4(static_cast<float>(light.shape), glm::distance(light.position, light.target), light.size)};
    return flow.pass(frameScope, {.stage = Stage::Lighting,
                                  .name = "lit",
                                  .work = Compute{"lighting.glsl"},
                                  .reads = {{"depth", surfaces.buffer.depth},
                                            {"normal", surfaces.buffer.normal},
                                            {"colour", surfaces.colour},
                                            {"shadow", shadow}},
                                  .writes = {{"lit", Format::RGBA16F, {view.size.x, view.size.y}, litChannels}},
                                  .constants = constants});
}

Image show(Flow& flow, const Session& session, Image shown) {
    const DisplayConstants constants{
        {std::exp2(session.display.exposure), static_cast<float>(session.display.show), 0, 0}};
    return flow.pass(frameScope, {.stage = Stage::Display,
                                  .name = "display",
                                  .work = Compute{"display.glsl"},
                                  .reads = {{"shown", shown}},
                                  .writes = {{"display", Format::RGBA8, flow.spec(shown).extent, displayChannels}},
                                  .constants = constants});
}

} // namespace

View sessionView(const Session& session, const Bounds& bounds) {
    // Between the nearest and the farthest corner of the scene; never nearer than 1/100000 of the farthest.
    const float reach =
        bounds.empty() ? 1.0f : glm::distance(session.camera.eye, bounds.centre()) + 0.5f * bounds.diagonal();
    const float far = std::max(1.01f * reach, 1e-6f);
    return makeView(session.camera, session.size, far * 1e-5f, far);
}

Frame buildFrame(Flow& flow, const Session& session, const SceneState& state, const Geometry* geometry,
                 const glm::mat4& lastClipFromWorld) {
    const View view = sessionView(session, state.bounds());
    pose(flow, state, geometry);
    const Surfaces surfaces = drawSurfaces(flow, view, state, geometry, lastClipFromWorld);
    const Inputs inputs{view,          session.light, surfaces.buffer, geometry, state.poseVersion(), state.occluders(),
                        session.frame, session.seed, session.progressive};
    const Scope instance{.instance = {}, .owner = session.techniques.card().id};
    const Image shadow = session.techniques.technique().build(flow, instance, inputs);
    const bool lit = session.display.show == Show::Lit;
    const Image display = show(flow, session, lit ? shade(flow, session, view, surfaces, shadow) : shadow);
    return {shadow, display, surfaces.buffer.depth};
}

} // namespace penumbra
