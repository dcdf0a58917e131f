// SPDX-License-Identifier: MIT
// No shadow map at all: what the scene costs and looks like before any shadows.
#include "renderer/core/technique.h"
#include "renderer/shadow_map/shadow_map.h"

namespace penumbra {
namespace {

class None final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return TextureReads{0, 0}; }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const LightViewBlock light = lightView(inputs, {.size = 1});
        return resolve(flow, scope, inputs,
                       {.shader = "techniques/none.glsl", .constants = resolveConstants(inputs, light)}, {},
                       parameters_);
    }

private:
    ParameterSet parameters_;
};

} // namespace

extern const Card noneCard;
const Card noneCard{
    .id = "none",
    .title = "No shadows",
    .authors = "-",
    .idea =
        "Only surfaces that face away from the light are dark. The base line for the cost of every other technique.",
    .assumes = "Nothing.",
    .fails = "Nothing casts a shadow.",
    .lidTolerance = 1,
    .make = [] { return std::unique_ptr<Technique>(new None); },
};

} // namespace penumbra
