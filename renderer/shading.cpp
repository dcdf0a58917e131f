// SPDX-License-Identifier: MIT
#include "renderer/shading.h"

#include "renderer/shadow_map/shadow_map.h"

#include <cmath>

namespace penumbra {
namespace {

constexpr Channel litChannels[] = {{"red", "", "reflected light, linear"},
                                   {"green", "", "reflected light, linear"},
                                   {"blue", "", "reflected light, linear"}};
constexpr Channel attenuationChannels[] = {
    {"attenuation", "", "by how much a shadow darkens what is shown, at most", Unit::None, 0, 1}};

struct LightingConstants {
    ViewBlock view;
    mat4 lightFromWorld;
    vec4 colour_ambient; // light's colour · intensity, w = ambient
    vec4 shape_reach;    // x = LightShape, y = distance at which intensity holds [m], zw = size of the light [m]
    vec4 exposure;       // x = factor on linear light before it is shown
};

PassSpec lighting(const View& view, const AreaLight& light, const GeometryBuffer& buffer, const Shading& shading) {
    const LightingConstants constants{
        viewBlock(view), lightFromWorld(light), vec4(light.colour * light.intensity, shading.ambient),
        vec4(static_cast<float>(light.shape), glm::distance(light.position, light.target), light.size),
        vec4(std::exp2(shading.exposure), 0, 0, 0)};
    return {.stage = Stage::Lighting,
            .work = Compute{"lighting.glsl"},
            .reads = {{"depth", buffer.depth}, {"normal", buffer.normal}, {"colour", shading.colour}},
            .constants = constants};
}

} // namespace

Image shade(Flow& flow, Scope scope, const View& view, const AreaLight& light, const GeometryBuffer& buffer,
            const Shading& shading, Image shadow) {
    PassSpec pass = lighting(view, light, buffer, shading);
    pass.name = "lit";
    pass.reads.push_back({"shadow", shadow});
    pass.writes.push_back({"lit", Format::RGBA16F, flow.spec(shadow).extent, litChannels});
    return flow.pass(scope, pass);
}

Image drawAttenuation(Flow& flow, const View& view, const AreaLight& light, const GeometryBuffer& buffer,
                      const Shading& shading) {
    PassSpec pass = lighting(view, light, buffer, shading);
    pass.name = "attenuation";
    std::get<Compute>(pass.work).defines.push_back({"ATTENUATION"});
    pass.writes.push_back({"attenuation", Format::R16F, flow.spec(buffer.depth).extent, attenuationChannels});
    return flow.pass({.owner = "scene"}, pass);
}

} // namespace penumbra
