// SPDX-License-Identifier: MIT
#include "renderer/shading.h"

#include "renderer/shadow_map/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace penumbra {
namespace {

constexpr Channel litChannels[] = {{"red", "", "reflected light, linear"},
                                   {"green", "", "reflected light, linear"},
                                   {"blue", "", "reflected light, linear"}};
constexpr Channel attenuationChannels[] = {
    {"attenuation", "", "by how much a shadow darkens what is shown, at most", Unit::None, 0, 1}};

struct LightConstants {
    mat4 lightFromWorld;
    vec4 colour;      // light's colour · intensity
    vec4 shape_reach; // x = LightShape, y = distance at which intensity holds [m], zw = size of the light [m]
};
struct LightingConstants {
    ViewBlock view;
    vec4 ambient_exposure; // x = ambient, y = factor on linear light before it is shown
    LightConstants lights[1 + mostFurtherLights];
};

LightConstants lightConstants(const AreaLight& light) {
    return {lightFromWorld(light), vec4(light.colour * light.intensity, 0),
            vec4(static_cast<float>(light.shape), glm::distance(light.position, light.target), light.size)};
}

PassSpec lighting(const View& view, std::span<const AreaLight* const> lights, const GeometryBuffer& buffer,
                  const Shading& shading) {
    LightingConstants constants{viewBlock(view), vec4(shading.ambient, std::exp2(shading.exposure), 0, 0), {}};
    std::transform(lights.begin(), lights.end(), constants.lights,
                   [](const AreaLight* light) { return lightConstants(*light); });
    return {.stage = Stage::Lighting,
            .work = Compute{"lighting.glsl", {{"LIGHTS", static_cast<int>(lights.size())}}},
            .reads = {{"depth", buffer.depth}, {"normal", buffer.normal}, {"colour", shading.colour}},
            .constants = constants};
}

} // namespace

Image shade(Flow& flow, Scope scope, const View& view, const ShadowedLights& lights, const GeometryBuffer& buffer,
            const Shading& shading) {
    static constexpr const char* samplers[] = {"shadow0", "shadow1", "shadow2", "shadow3"};
    static_assert(std::size(samplers) == 1 + mostFurtherLights);
    FixedVector<const AreaLight*, 1 + mostFurtherLights> shining;
    for (const Shadowed& light : lights) shining.push_back(light.light);
    PassSpec pass = lighting(view, {shining.data(), shining.size()}, buffer, shading);
    pass.name = "lit";
    for (size_t i = 0; i < lights.size(); ++i) pass.reads.push_back({samplers[i], lights[i].shadow});
    pass.writes.push_back({"lit", Format::RGBA16F, flow.spec(lights[0].shadow).extent, litChannels});
    return flow.pass(scope, pass);
}

Image drawAttenuation(Flow& flow, std::string_view instance, const View& view, const AreaLight& light,
                      const GeometryBuffer& buffer, const Shading& shading) {
    const AreaLight* only = &light;
    PassSpec pass = lighting(view, {&only, 1}, buffer, shading);
    pass.name = "attenuation";
    std::get<Compute>(pass.work).defines.push_back({"ATTENUATION"});
    pass.writes.push_back({"attenuation", Format::R16F, flow.spec(buffer.depth).extent, attenuationChannels});
    return flow.pass({.instance = instance, .owner = "scene"}, pass);
}

} // namespace penumbra
