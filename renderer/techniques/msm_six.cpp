// SPDX-License-Identifier: MIT
// Algorithm 2 of Peters and Klein (i3D 2015) for six moments, one step beyond the four that the paper settles on: three
// surfaces within a kernel are reconstructed exactly but for the bias, and bounds are sharper everywhere. For two
// moments the algorithm is variance shadow mapping, for four msm-hamburger.
//
// Depths are in [−1, 1] and kept as 32-bit floats: two layers, 32 bytes a texel.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    MomentBias momentBias{*this, [](const ParameterSet&) { return 1e-4; }};
    BiasParameters bias{*this, {.slope = 0, .normalOffset = 0, .slopeFrom = planeBias}};
};

class MsmSix final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.sampling.reads(2); }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        static constexpr Channel channels[] = {
            {"b1", "b₁, b₅", "mean of the depth in [−1, 1]; second layer: of its fifth power"},
            {"b2", "b₂, b₆", "mean of its square; second layer: of its sixth power"},
            {"b3", "b₃", "mean of its third power"},
            {"b4", "b₄", "mean of its fourth power"}};
        const Parameters& p = parameters_;
        constexpr glm::vec2 depth{2, -1};
        const MomentMap map = drawMomentMap(flow, scope, inputs,
                                            {.map = p.map.describe(),
                                             .sampling = p.sampling.describe(),
                                             .kernel = p.kernel.kernel,
                                             .sigma = p.kernel.sigma,
                                             .format = Format::RGBA32F,
                                             .layers = 2,
                                             .depth = depth,
                                             .channels = channels});
        const float alpha = p.momentBias;
        const MomentLookupBlock lookup{.momentsFromStored = glm::mat4(1 - alpha),
                                       .momentsOffset = glm::vec4(0),
                                       .depth_exponents = glm::vec4(depth, 0, 0),
                                       .range = glm::vec4(alpha, 0, 0, 0)};
        return resolveMoments(flow, scope, inputs, "techniques/msm_six.glsl", map, lookup, p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card msmSixCard;
const Card msmSixCard{
    .id = "msm-six",
    .title = "Moment shadow mapping, six moments",
    .authors = "Peters, Klein",
    .year = 2015,
    .venue = "i3D",
    .idea =
        "Filter the first six powers of the depth; of all depths that have these six means, take those that cast the "
        "least shadow.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. At most "
               "three surfaces within the kernel.",
    .fails = "Four and more surfaces within the kernel leak light, and so do contacts: six moments need hundreds of "
             "times the bias of four, and four times the memory at 16 bits.",
    .litTolerance = 1e-3,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new MsmSix); },
};

} // namespace penumbra
