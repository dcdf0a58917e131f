// SPDX-License-Identifier: MIT
// Shadow mapping (Williams, SIGGRAPH 1978): one depth comparison a pixel, 1 texture read, 4 bytes a texel.
#include "renderer/core/technique.h"
#include "renderer/shadow_map/shadow_map.h"

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.fit = Fit::View}};
    BiasParameters bias{*this, {.slope = 0.5, .normalOffset = 0.5}};
};

class Hard final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return TextureReads{1, 1}; }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const ShadowMap map = drawShadowMap(flow, scope, inputs, parameters_.map.describe());
        return resolve(flow, scope, inputs,
                       {.shader = "techniques/hard.glsl", .constants = resolveConstants(inputs, map.view)},
                       {{"shadowMap", map.depth}}, parameters_);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card hardCard;
const Card hardCard{
    .id = "hard",
    .title = "Hard shadows",
    .authors = "Williams",
    .year = 1978,
    .venue = "SIGGRAPH",
    .idea = "Draw the scene's depth as seen from the light; what lies behind that depth is in shadow.",
    .assumes = "A point light in the centre of the area light.",
    .fails = "No penumbrae. Staircase edges as wide as a texel; acne or detached shadows where the bias does not fit.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-4,
    .make = [] { return std::unique_ptr<Technique>(new Hard); },
};

} // namespace penumbra
