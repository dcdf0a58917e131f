// SPDX-License-Identifier: MIT
#include "renderer/frame.h"

#include "renderer/shading.h"
#include "renderer/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

constexpr Scope frameScope{};
constexpr Scope truthScope{.instance = {}, .owner = "truth"};
constexpr Scope compareScope{.instance = {}, .owner = "compare"};

constexpr Channel truthChannels[] = {
    {"shadow", "ψ*", "share of the light that is not seen, by traced rays", Unit::None, 0, 1},
    {"counted", "", "1 where errors are counted: the surface faces the whole light", Unit::None, 0, 1}};
constexpr Channel errorChannels[] = {
    {"error", "e", "ψ of the technique minus the truth or ψ of technique B; positive: too dark", Unit::None, -1, 1},
    {"counted", "", "1 where errors are counted", Unit::None, 0, 1}};
constexpr Channel displayChannels[] = {{"red", "", "as shown, sRGB", Unit::None, 0, 1},
                                       {"green", "", "as shown, sRGB", Unit::None, 0, 1},
                                       {"blue", "", "as shown, sRGB", Unit::None, 0, 1}};

struct DisplayConstants {
    vec4 exposure_show; // x = factor, y = Show
    vec4 halves;        // x = first column that shows the other image, y = the column where that image begins
    vec4 gain;          // x = factor on errors
};

Image supply(Flow& flow, const TruthImage& truth, glm::ivec2 size) {
    return flow.pass(truthScope, {.stage = Stage::Display,
                                  .name = "shadow",
                                  .work = Supply{truth.texels},
                                  .writes = {{"shadow", Format::RG32F, {size.x, size.y}, truthChannels}}});
}

// ψ of the technique minus another one, or ψ*.
Image subtract(Flow& flow, const Surfaces& surfaces, Image shadow, Image other, bool isTruth) {
    PassSpec pass{.stage = Stage::Display,
                  .name = "error",
                  .work = Compute{"error.glsl"},
                  .reads = {{"shadow", shadow}, {"other", other}},
                  .writes = {{"error", Format::RG32F, flow.spec(shadow).extent, errorChannels}}};
    if (isTruth)
        std::get<Compute>(pass.work).defines.push_back({"TRUTH"});
    else
        pass.reads.push_back({"depth", surfaces.buffer.depth});
    return flow.pass(compareScope, pass);
}

// One image, or two with a line between them.
Image show(Flow& flow, const Session& session, Image shown, std::optional<Image> other = {}) {
    const Comparison& comparison = session.comparison;
    Extent extent = flow.spec(shown).extent;
    DisplayConstants constants{{std::exp2(session.display.exposure), static_cast<float>(session.display.show), 0, 0},
                               vec4(0),
                               vec4(comparison.gain, 0, 0, 0)};
    PassSpec pass{
        .stage = Stage::Display, .name = "display", .work = Compute{"display.glsl"}, .reads = {{"shown", shown}}};
    if (other) {
        std::get<Compute>(pass.work).defines.push_back({"COMPARED"});
        if (comparison.exchanged) std::swap(shown, *other);
        const auto width = static_cast<float>(extent.width);
        switch (comparison.as) {
        case CompareAs::Wipe: constants.halves.x = std::round(comparison.line * width); break;
        case CompareAs::SideBySide:
            constants.halves = vec4(width, width, 0, 0);
            extent.width *= 2;
            break;
        case CompareAs::Flip:
        case CompareAs::Error: ensure(false, "one image at a time was to be shown"); break;
        }
        pass.reads = {{"shown", shown}, {"other", *other}};
    } else if (session.comparing() && comparison.as == CompareAs::Error) {
        std::get<Compute>(pass.work).defines.push_back({"ERROR_MAP"});
    }
    pass.writes = {{"display", Format::RGBA8, extent, displayChannels}};
    pass.constants = constants;
    return flow.pass(frameScope, pass);
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
                 const LastFrame* last, const Inspection& inspection) {
    const Comparison& comparison = session.comparison;
    const bool two = comparison.against == Against::Technique;
    // One geometry buffer for all, as large as any of them wants it.
    const auto marginOf = [&](glm::ivec2 size) {
        const glm::ivec2 own = session.techniques.technique().margin(size);
        return two ? glm::max(own, session.rival.technique().margin(size)) : own;
    };
    const glm::ivec2 margin = marginOf(session.size);
    const View view = grown(sessionView(session, state.bounds()), margin);
    const View lastView = last ? grown(last->view, marginOf(last->view.size)) : view;
    poseVertices(flow, state, geometry);
    const Surfaces surfaces = drawSurfaces(flow, view, state, geometry, lastView.clipFromWorld);
    const Shading shading{surfaces.colour, session.display.ambient, session.display.exposure};
    // Two techniques are instances a and b of one frame; what they need alike, such as the geometry buffer, is made
    // once.
    const bool errorMap = session.comparing() && comparison.as == CompareAs::Error;
    const bool lit = session.display.show == Show::Lit && !errorMap;
    const auto build = [&](const TechniqueShelf& shelf, std::string_view instance, const AreaLight& light,
                           const AreaLight* lastLight) {
        const Inputs inputs{view,
                            light,
                            surfaces.buffer,
                            geometry,
                            state.poseVersion(),
                            state.occluders(),
                            session.frame,
                            session.seed,
                            session.progressive,
                            margin,
                            last,
                            lastLight,
                            inspection,
                            &shading};
        shelf.parameters().refuseBeyondLimits();
        return shelf.technique().build(flow, {instance, shelf.card().id}, inputs);
    };
    using Instances = std::array<std::string_view, 1 + mostFurtherLights>;
    // ψ of every light that shines, each an instance of its own; the others only where light is shown.
    const auto buildAll = [&](const TechniqueShelf& shelf, const Instances& instances) {
        ShadowedLights all{{&session.light, build(shelf, instances[0], session.light, last ? &last->light : nullptr)}};
        for (size_t i = 0; lit && i < session.furtherLights.size(); ++i) {
            const auto& [light, on] = session.furtherLights[i];
            const bool shone = last && i < last->furtherLights.size() && last->furtherLights[i].on;
            if (on)
                all.push_back(
                    {&light, build(shelf, instances[1 + i], light, shone ? &last->furtherLights[i].light : nullptr)});
        }
        return all;
    };
    static constexpr Instances single{"", "light-2", "light-3", "light-4"};
    static constexpr Instances a{"a", "a/light-2", "a/light-3", "a/light-4"};
    static constexpr Instances b{"b", "b/light-2", "b/light-3", "b/light-4"};
    const ShadowedLights lights = buildAll(session.techniques, two ? a : single);
    const Image shadow = lights[0].shadow;
    ShadowedLights otherLights = lights; // what is compared with, where it is known
    std::optional<Image> rival, other;
    if (two) {
        otherLights = buildAll(session.rival, b);
        rival = other = otherLights[0].shadow;
    }
    if (const TruthImage* known = session.currentTruth()) {
        const Image truth = supply(flow, *known, session.size);
        if (comparison.against == Against::Truth) other = otherLights[0].shadow = truth;
    }

    const auto seen = [&](const ShadowedLights& of, Scope scope) {
        return lit ? shade(flow, scope, view, of, surfaces.buffer, shading) : of[0].shadow;
    };
    const auto display = [&] {
        const Scope own{.instance = two ? "a" : "", .owner = {}};
        if (!other) return show(flow, session, seen(lights, own));
        if (errorMap) return show(flow, session, subtract(flow, surfaces, shadow, *other, !two));
        const Scope others = two ? Scope{.instance = "b", .owner = {}} : truthScope;
        if (comparison.as == CompareAs::Flip)
            return show(flow, session, comparison.exchanged ? seen(otherLights, others) : seen(lights, own));
        return show(flow, session, seen(lights, own), seen(otherLights, others));
    };
    return {shadow, rival, display(), surfaces.buffer.depth};
}

std::vector<LightLayer> buildLightLayers(Flow& flow, const Session& session, const SceneState& state,
                                         const Geometry* geometry, int size, int layers) {
    const View view = lightsView(lightView(session.light, state.occluders(), {.size = size}), state.occluders());
    session.techniques.parameters().refuseBeyondLimits();
    poseVertices(flow, state, geometry);
    std::vector<LightLayer> drawn;
    for (const GeometryBuffer& buffer : drawLightLayers(flow, view, state, geometry, layers)) {
        const Inputs inputs{view,          session.light, buffer, geometry, state.poseVersion(), state.occluders(),
                            session.frame, session.seed};
        // Maps and what is filtered of them are alike for all layers and made once.
        const Scope scope{lightLayerName(static_cast<int>(drawn.size())), session.techniques.card().id};
        drawn.push_back({buffer.depth, session.techniques.technique().build(flow, scope, inputs)});
    }
    return drawn;
}

} // namespace penumbra
