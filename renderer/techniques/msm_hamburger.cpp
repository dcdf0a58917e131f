// SPDX-License-Identifier: MIT
// Hamburger four-moment shadow mapping (Peters and Klein, i3D 2015): a map of the first four powers of the depth,
// filtered; of all distributions of depth that have the four filtered moments, wherever on the real line, the one that
// puts least in front of the fragment is ψ, in closed form (algorithm 3).
//
// Two surfaces within a kernel are reconstructed exactly but for the bias; more make shadows too light, never too dark.
// One bilinear sample a pixel, whatever the kernel. 8 bytes a texel, twice (rows, then columns), and the depth map.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    KernelParameters kernel{*this};
    MomentParameters moments{*this, MomentFormat::Unorm16Optimised, DepthSign::Signed};
    MomentBias momentBias{*this};
    BiasParameters bias{*this, {.slope = 0, .normalOffset = 0, .slopeFrom = planeBias}};
};

class MsmHamburger final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return TextureReads{4, 4}; }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const MomentMap map =
            drawMomentMap(flow, scope, inputs, describePowers(4, p.map.describe(), p.kernel, p.moments));
        return resolveMoments(flow, scope, inputs, "techniques/msm_hamburger.glsl", map,
                              lookupOfPowers(4, p.moments, p.momentBias), p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card msmHamburgerCard;
const Card msmHamburgerCard{
    .id = "msm-hamburger",
    .title = "Moment shadow mapping",
    .authors = "Peters, Klein",
    .year = 2015,
    .venue = "i3D",
    .idea = "Filter the first four powers of the depth; of all depths that have these four means, take those that cast "
            "the least shadow.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. At most "
               "two surfaces within the kernel.",
    .fails =
        "Three and more surfaces within the kernel leak light, and so do contacts, by the moment bias that rounding "
        "needs; with less bias lit surfaces speckle.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new MsmHamburger); },
};

} // namespace penumbra
