// SPDX-License-Identifier: MIT
// Exponential variance shadow maps (Lauritzen and McCool, GI 2008): variance shadow maps of warped depths. With x = 2z
// − 1 exp(c₊ x) spreads out what lies far, so that nearer casters hardly add to the variance; −exp(−c₋ x) does the
// reverse. Each warp bounds ψ from below; with four components the larger bound counts.
#include "renderer/shadow_map/moment_map.h"

namespace penumbra {
namespace {

// A square is stored: exp(2c) must be in the format's range.
double largestExponent(const ParameterSet& set) { return isHalf(set) ? 5.54 : 44; }

bool hasNegative(const ParameterSet& set) { return set.at("components").value() == 1; }

enum class Components { Two, Four };
constexpr std::string_view componentNames[] = {"2", "4"};

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    FloatFormatChoice format{*this};
    Choice<Components> components{
        *this,
        {.id = "components",
         .value = double(Components::Four),
         .source = "Lauritzen and McCool 2008; Lauritzen 2011",
         .help =
             "Two: the positive warp alone, half of the memory. Four: the negative warp as well, which darkens what "
             "lies in front of most of the kernel.",
         .choices = componentNames}};
    Real positive{*this,
                  {.id = "positive-exponent",
                   .label = "Positive exponent",
                   .symbol = "c₊",
                   .min = 0.5,
                   .max = 44,
                   .scale = Scale::Logarithmic,
                   .source = "Lauritzen and McCool 2008",
                   .help = "Of the warp that spreads out what is far. More of it leaks less light behind casters that "
                           "overlap; the limit is the format's.",
                   .defaultFrom = [](const ParameterSet& set) { return isHalf(set) ? 5.54 : 40.0; },
                   .limitFrom = largestExponent,
                   .limitReason = "the largest whose squared power the format holds"}};
    Real negative{*this,
                  {.id = "negative-exponent",
                   .label = "Negative exponent",
                   .symbol = "c₋",
                   .value = 5,
                   .min = 0.5,
                   .max = 44,
                   .scale = Scale::Logarithmic,
                   .source = "Lauritzen 2011 (5)",
                   .help = "Of the warp that spreads out what is near. More of it finds shadow in front of most of the "
                           "kernel, and acne on lit slopes.",
                   .limitFrom = largestExponent,
                   .limitReason = "the largest whose squared power the format holds",
                   .active = hasNegative,
                   .inactiveReason = "two components have the positive warp alone"}};
    Real deviation{*this,
                   {.id = "minimum-deviation",
                    .label = "Minimum deviation",
                    .symbol = "σ_min",
                    .min = 0,
                    .max = 1e-2,
                    .unit = Unit::DepthRange,
                    .scale = Scale::Logarithmic,
                    .smallest = 1e-7,
                    .source = "Lauritzen 2007, warped",
                    .help = "Standard deviations below count as this. Hides rounding on lit surfaces; more of it lets "
                            "light through at contacts.",
                    .defaultFrom = [](const ParameterSet& set) { return isHalf(set) ? 2e-3 : 5e-5; }}};
    LightBleedingReduction bleeding{*this};
    BiasParameters bias{*this, {.slope = 0.5, .normalOffset = 0.5}};
};

class Evsm final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override { return parameters_.sampling.reads(); }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        static constexpr Channel channels[] = {{"p", "e^c₊x", "mean of the positive warp of the depth x = 2z − 1"},
                                               {"p2", "e^2c₊x", "mean of its square"},
                                               {"n", "−e^−c₋x", "mean of the negative warp"},
                                               {"n2", "e^−2c₋x", "mean of its square"}};
        const Parameters& p = parameters_;
        const bool four = p.components == Components::Four;
        const Format format = four        ? isHalf(p) ? Format::RGBA16F : Format::RGBA32F
                              : isHalf(p) ? Format::RG16F
                                          : Format::RG32F;
        const glm::vec2 exponents{float(p.positive), float(p.negative)};
        const MomentMap map = drawMomentMap(flow, scope, inputs,
                                            {.map = p.map.describe(),
                                             .sampling = p.sampling.describe(),
                                             .kernel = p.kernel.kernel,
                                             .sigma = p.kernel.sigma,
                                             .functions = DepthFunctions::Exponentials,
                                             .format = format,
                                             .depth = {2, -1},
                                             .exponents = exponents,
                                             .channels = std::span(channels).first(four ? 4 : 2)});
        const MomentLookupBlock lookup{.momentsFromStored = glm::mat4(1),
                                       .momentsOffset = glm::vec4(0),
                                       .depth_exponents = glm::vec4(2, -1, exponents),
                                       .range = glm::vec4(-1, 1, 0, 0)};
        return resolveMoments(flow, scope, inputs, "techniques/evsm.glsl", map, lookup, p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card evsmCard;
const Card evsmCard{
    .id = "evsm",
    .title = "Exponential variance shadow maps",
    .authors = "Lauritzen, McCool",
    .year = 2008,
    .venue = "Graphics Interface",
    .idea =
        "Variance shadow maps of exponentially warped depths: what lies nearer than the last caster hardly counts, so "
        "that little light leaks.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts.",
    .fails = "Where two casters overlap, light leaks close behind the farther one and in front of it shadows are too "
             "light or lost; 16-bit floats allow exponents so small that it leaks as variance shadow maps do.",
    .litTolerance = 1e-3,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new Evsm); },
};

} // namespace penumbra
