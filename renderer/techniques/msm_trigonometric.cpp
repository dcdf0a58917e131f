// SPDX-License-Identifier: MIT
// Trigonometric moment shadow mapping (Peters and Klein, i3D 2015, section 3): a map of two sines and two cosines of
// the depth, filtered; of all distributions that have these means the one that puts least in front of the fragment is
// ψ. The paper found these four functions the best of thousands and gives no algorithm;
// shaders/lib/moments_trigonometric.glsl has one that needs neither a quartic nor a branch.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

enum class StoredAs { Float32, Float16, Snorm16 };
constexpr std::string_view formatNames[] = {"32f", "16f", "snorm16"};

double usualBias(const ParameterSet& set) {
    switch (static_cast<StoredAs>(static_cast<int>(set.at("format").value()))) {
    case StoredAs::Float32: return 3e-5;
    case StoredAs::Float16: return 1e-3;
    case StoredAs::Snorm16: return 1e-4;
    }
    return 0;
}

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    Choice<StoredAs> format{*this,
                            {.id = "format",
                             .value = double(StoredAs::Float32),
                             .help = "How a texel keeps its four means, 16 or 8 bytes. 16 bits need more moment bias.",
                             .choices = formatNames}};
    Real momentBias{*this,
                    {.id = "moment-bias",
                     .label = "Moment bias",
                     .symbol = "α",
                     .min = 0,
                     .max = 1e-2,
                     .scale = Scale::Logarithmic,
                     .smallest = 1e-8,
                     .source = "Peters and Klein 2015, section 4.2",
                     .help =
                         "Share of all depths, evenly, that is mixed into the means, so that rounding cannot make "
                         "them impossible. Too little speckles lit surfaces, too much lets light through at contacts.",
                     .defaultFrom = usualBias}};
    Real margin{*this,
                {.id = "near-margin",
                 .label = "Near margin",
                 .value = 0.1,
                 .min = 0,
                 .max = 0.5,
                 .unit = Unit::DepthRange,
                 .source = "ours; Münstermann et al. 2018 (wrapping zone)",
                 .help = "Sines take the near end for the far end. This share of the circle stays empty before the "
                         "nearest depth, so that what casts there is not lost."}};
    BiasParameters bias{*this, {.slope = 0, .normalOffset = 0, .slopeFrom = planeBias}};
};

class MsmTrigonometric final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.sampling.reads(); }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        static constexpr Channel channels[] = {
            {"sin", "sin 2πx", "mean of the depth's sine", Unit::None, -1, 1},
            {"cos", "cos 2πx", "mean of its cosine", Unit::None, -1, 1},
            {"sin2", "sin 4πx", "mean of the sine of twice it", Unit::None, -1, 1},
            {"cos2", "cos 4πx", "mean of the cosine of twice it", Unit::None, -1, 1}};
        static constexpr Format formats[] = {Format::RGBA32F, Format::RGBA16F, Format::RGBA16Snorm};
        const Parameters& p = parameters_;
        const glm::vec2 depth{1 - float(p.margin), float(p.margin)};
        const MomentMap map = drawMomentMap(flow, scope, inputs,
                                            {.map = p.map.describe(),
                                             .sampling = p.sampling.describe(),
                                             .kernel = p.kernel.kernel,
                                             .sigma = p.kernel.sigma,
                                             .functions = DepthFunctions::Trigonometric,
                                             .format = formats[static_cast<size_t>(StoredAs(p.format))],
                                             .depth = depth,
                                             .channels = channels});
        const float alpha = p.momentBias;
        // What the bias leaves a single surface of the pivots; less is rounding.
        const MomentLookupBlock lookup{.momentsFromStored = glm::mat4(1 - alpha),
                                       .momentsOffset = glm::vec4(0),
                                       .depth_exponents = glm::vec4(depth, 0, 0),
                                       .range = glm::vec4(0, 1, 0, std::max(alpha, 1e-7f))};
        return resolveMoments(flow, scope, inputs, "techniques/msm_trigonometric.glsl", map, lookup, p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card msmTrigonometricCard;
const Card msmTrigonometricCard{
    .id = "msm-trigonometric",
    .title = "Trigonometric moment shadow mapping",
    .authors = "Peters, Klein",
    .year = 2015,
    .venue = "i3D",
    .idea = "Filter two sines and two cosines of the depth; of all depths that have these four means, take those that "
            "cast the least shadow.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. At most "
               "two surfaces within the kernel.",
    .fails =
        "Three and more surfaces within the kernel leak light, and so do contacts, by the moment bias. The search for "
        "the least costs several times what four powers cost.",
    .litTolerance = 1e-3,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new MsmTrigonometric); },
};

} // namespace penumbra
