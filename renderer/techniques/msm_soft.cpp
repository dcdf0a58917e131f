// SPDX-License-Identifier: MIT
// Moment soft shadow mapping (Peters, Münstermann, Wetzstein and Klein, JCGT 2017): percentage-closer soft shadows
// whose search and filter are windows of a summed-area table of four powers of the depth. Of the three atoms that
// Hamburger's bound puts into a window those in front of the fragment are what blocks.
#include "renderer/shadow_map/summed_area.h"

#include <algorithm>

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.fit = Fit::View, .largest = largestMomentMap}};
    SoftMomentParameters windows{*this};
    MomentBias momentBias{*this, [](const ParameterSet& set) {
                              // By the number of steps; sums over many texels have little of their rounding left.
                              return std::clamp(0.07 / SoftMomentParameters::levelsOf(set), 3e-7, 1e-2);
                          }};
    BiasParameters bias{*this, {.slope = 0.05, .normalOffset = 0.25}};
};

class MsmSoft final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.windows.reads(); }
    std::span<const ProbePlot> probePlots() const override { return windowPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const SummedArea table = drawSummedArea(flow, scope, inputs, 4, p.map.describe(), p.windows);
        return resolveSoft(flow, scope, inputs, "techniques/msm_soft.glsl", 4, table, p.windows, p, p.momentBias);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card msmSoftCard;
const Card msmSoftCard{
    .id = "msm-soft",
    .title = "Moment soft shadow mapping",
    .authors = "Peters, Münstermann, Wetzstein, Klein",
    .year = 2017,
    .venue = "Journal of Computer Graphics Techniques",
    .idea =
        "Sum up four powers of the depth so that the moments of any window are known; of all depths that have them, "
        "those that cast the least shadow tell the depth of what blocks, and then ψ.",
    .assumes =
        "Light, blocker and receiver are parallel, and all blockers of a point lie at one depth. One map, from the "
        "light's centre. At most two surfaces within a cell.",
    .fails =
        "Three and more surfaces within a cell leak light, and so do contacts, by the bias that lit slopes and "
        "rounding need; windows beyond the widest are cut. What the centre of the light does not see casts nothing.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new MsmSoft); },
};

} // namespace penumbra
