// SPDX-License-Identifier: MIT
// Hausdorff four-moment shadow mapping (Peters and Klein, i3D 2015): the map of msm-hamburger, and of all distributions
// with the four filtered moments whose depths lie in the map's range the one that puts least in front of the fragment.
// Knowing the range makes contact shadows darker: a single surface is reconstructed exactly in spite of the bias.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    KernelParameters kernel{*this};
    MomentParameters moments{*this, MomentFormat::Unorm16Optimised, DepthSign::Unsigned};
    MomentBias momentBias{*this};
    BiasParameters bias{*this, {.slope = 0, .normalOffset = 0, .slopeFrom = planeBias}};
};

class MsmHausdorff final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return TextureReads{4, 4}; }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const MomentMap map =
            drawMomentMap(flow, scope, inputs, describePowers(4, p.map.describe(), p.kernel, p.moments));
        return resolveMoments(flow, scope, inputs, "techniques/msm_hausdorff.glsl", map,
                              lookupOfPowers(4, p.moments, p.momentBias), p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card msmHausdorffCard;
const Card msmHausdorffCard{
    .id = "msm-hausdorff",
    .title = "Moment shadow mapping, bounded depth",
    .authors = "Peters, Klein",
    .year = 2015,
    .venue = "i3D",
    .idea = "Moment shadow mapping that also knows that all depths lie within the map's range.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. At most "
               "two surfaces within the kernel.",
    .fails =
        "Three and more surfaces within the kernel leak light. What 16 bits round away shows as noise at contacts.",
    .litTolerance = 1e-3,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new MsmHausdorff); },
};

} // namespace penumbra
