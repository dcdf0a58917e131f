// SPDX-License-Identifier: MIT
// What techniques that bound ψ by four moments of the depth (Peters and Klein 2015) have in common: all but the bound.
// One bilinear sample a pixel, whatever the kernel. 8 bytes a texel, twice (rows, then columns), and the depth map.
#pragma once

#include "renderer/shadow_map/moment_map.h"

namespace penumbra {

class FourMoments : public Technique {
public:
    // `shader` reads the map and has the bound, which leaves lit planes lit at this bias.
    using SlopeBias = double (*)(const ParameterSet&);
    FourMoments(std::string_view shader, SlopeBias usualBias) : shader_(shader), parameters_(usualBias) {}
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.sampling.reads(); }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const Parameters& p = parameters_;
        const MomentMap map = drawMomentMap(
            flow, scope, inputs, describePowers(4, p.map.describe(), p.sampling.describe(), p.kernel, p.moments));
        return resolveMoments(flow, scope, inputs, shader_, map, lookupOfPowers(4, p.moments, p.momentBias), p);
    }

private:
    struct Parameters : ParameterSet {
        explicit Parameters(SlopeBias usualBias)
            : bias(*this, {.slope = 0, .normalOffset = 0, .slopeFrom = usualBias}) {}
        ShadowMapParameters map{*this, {.largest = largestMomentMap}};
        MapSamplingParameters sampling{*this};
        KernelParameters kernel{*this};
        MomentParameters moments{*this, MomentFormat::Unorm16Optimised, DepthSign::Signed};
        MomentBias momentBias{*this};
        BiasParameters bias;
    };

    std::string_view shader_;
    Parameters parameters_;
};

} // namespace penumbra
