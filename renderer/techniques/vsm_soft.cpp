// SPDX-License-Identifier: MIT
// Variance soft shadow mapping (Yang et al., Pacific Graphics 2010): percentage-closer soft shadows whose search and
// filter are windows of a summed-area table of the depth and its square. Mean and variance say that a share of 1 − ψ
// lies at the fragment and the rest at one depth in front of it, which is that of the blocker.
#include "renderer/shadow_map/summed_area.h"

#include <algorithm>

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.fit = Fit::View, .largest = largestMomentMap}};
    SoftMomentParameters windows{*this};
    MinimumVariance minimumVariance{
        *this, [](const ParameterSet& set) { return std::max(0.25 / SoftMomentParameters::levelsOf(set), 1e-7); }};
    BiasParameters bias{*this, {.slope = 0.05, .normalOffset = 0.25}};
};

class VsmSoft final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.windows.reads(); }
    std::span<const ProbePlot> probePlots() const override { return windowPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const SummedArea table = drawSummedArea(flow, scope, inputs, 2, p.map.describe(), p.windows);
        return resolveSoft(flow, scope, inputs, "techniques/vsm_soft.glsl", 2, table, p.windows, p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card vsmSoftCard;
const Card vsmSoftCard{
    .id = "vsm-soft",
    .title = "Variance soft shadow mapping",
    .authors = "Yang, Dong, Feng, Seidel, Kautz",
    .year = 2010,
    .venue = "Pacific Graphics",
    .idea = "Sum up the depth and its square so that mean and variance of any window are known; they tell the depth of "
            "what blocks, and then how much of the penumbra's window it covers.",
    .assumes =
        "Light, blocker and receiver are parallel, and all blockers of a point lie at one depth. One map, from the "
        "light's centre. Within a cell what casts and what receives are one surface each.",
    .fails =
        "Light leaks wherever casters at several depths share a cell, and what lies close to the receiver casts too "
        "little where that is steep; windows beyond the widest are cut. What the centre of the light does not see "
        "casts nothing.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new VsmSoft); },
};

} // namespace penumbra
