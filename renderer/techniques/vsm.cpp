// SPDX-License-Identifier: MIT
// Variance shadow maps (Donnelly and Lauritzen, i3D 2006): a map of the depth and its square, filtered; Cantelli's
// inequality bounds ψ from mean and variance. Light-bleeding reduction and the least variance are those of Lauritzen
// (GPU Gems 3, chapter 8).
//
// Exact for two surfaces of which the fragment lies on the farther one. One bilinear sample a pixel, whatever the
// kernel.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    MomentParameters moments{*this, MomentFormat::Float32, DepthSign::Unsigned};
    MinimumVariance minimumVariance{*this};
    LightBleedingReduction bleeding{*this};
    BiasParameters bias{*this, {.slope = 0.5, .normalOffset = 0.5}};
};

class Vsm final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.sampling.reads(); }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const MomentMap map = drawMomentMap(
            flow, scope, inputs, describePowers(2, p.map.describe(), p.sampling.describe(), p.kernel, p.moments));
        return resolveMoments(flow, scope, inputs, "techniques/vsm.glsl", map, lookupOfPowers(2, p.moments), p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card vsmCard;
const Card vsmCard{
    .id = "vsm",
    .title = "Variance shadow maps",
    .authors = "Donnelly, Lauritzen",
    .year = 2006,
    .venue = "i3D",
    .idea = "Filter the depth and its square; mean and variance bound the share of depths that lie in front of a "
            "fragment.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. Within "
               "the kernel what casts and what receives are one surface each.",
    .fails =
        "Light leaks into shadows wherever something farther than one caster and nearer than the fragment casts as "
        "well.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new Vsm); },
};

} // namespace penumbra
