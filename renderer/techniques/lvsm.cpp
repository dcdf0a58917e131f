// SPDX-License-Identifier: MIT
// Layered variance shadow maps (Lauritzen and McCool, GI 2008): a variance shadow map for each slice of the depth
// range. Depths outside a slice count as at its ends, so that only casters within it can leak light into each other's
// shadow. Every slice bounds ψ from below; the largest bound counts.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

constexpr int mostSlices = 8;

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    MomentFormatChoice format{*this, MomentFormat::Unorm16Optimised};
    Integer slices{*this,
                   {.id = "layers",
                    .value = 4,
                    .min = 1,
                    .max = mostSlices,
                    .source = "Lauritzen and McCool 2008",
                    .help = "Slices of the depth range, all of one depth. Light leaks only between casters in the same "
                            "slice; memory and time grow with them. One is variance shadow mapping."}};
    Real overlap{*this,
                 {.id = "overlap",
                  .value = 0.05,
                  .min = 0,
                  .max = 0.5,
                  .source = "Lauritzen and McCool 2008, section 4",
                  .help = "How far slices reach into each other, as a share of their depth: what lies at an end of one "
                          "is seen whole by the next. Without it lit surfaces show a line where slices meet."}};
    MinimumVariance minimumVariance{*this};
    LightBleedingReduction bleeding{*this};
    BiasParameters bias{*this, {.slope = 0.5, .normalOffset = 0.5}};
};

class Lvsm final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        return parameters_.sampling.reads((parameters_.slices + 1) / 2);
    }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const MomentMap map = drawMomentMap(
            flow, scope, inputs,
            describeSlices(p.slices, p.map.describe(), p.sampling.describe(), p.kernel, p.format, p.overlap));
        return resolveMoments(flow, scope, inputs, "techniques/lvsm.glsl", map, lookupOfSlices(p.format), p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card lvsmCard;
const Card lvsmCard{
    .id = "lvsm",
    .title = "Layered variance shadow maps",
    .authors = "Lauritzen, McCool",
    .year = 2008,
    .venue = "Graphics Interface",
    .idea =
        "A variance shadow map for each slice of the depth range: casters that lie in different slices leak no light "
        "into each other's shadows.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. Casters "
               "that overlap lie in different slices.",
    .fails =
        "Light leaks between casters in one slice as variance shadow maps leak it, and how much jumps where slices "
        "meet.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new Lvsm); },
};

} // namespace penumbra
