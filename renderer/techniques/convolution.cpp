// SPDX-License-Identifier: MIT
// Convolution shadow maps (Annen et al., EGSR 2007): the comparison of two depths as a Fourier series is a sum of
// products of functions of the one and of the other; a map of the functions of what casts is filtered, and the sum is
// taken at the receiver. Filtering then is as good as percentage-closer filtering of the truncated series.
//
// The series is ½ where both depths are equal and has ripples. `doubled` shows twice of it, so that what lies on the
// surface itself is lit; `bound` moves the receiver by half a ripple and scales, so that visibility is never less than
// in truth. Two images of M / 2 layers; every one of them is read once a pixel.
#include "renderer/shadow_map/moment_map.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr int mostTerms = 16;

enum class StoredAs { Float32, Float16, Snorm16 };
constexpr std::string_view formatNames[] = {"32f", "16f", "snorm16"};
enum class Shown { Series, Doubled, Bound };
constexpr std::string_view shownNames[] = {"series", "doubled", "bound"};

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    Choice<StoredAs> format{*this,
                            {.id = "format",
                             .value = double(StoredAs::Snorm16),
                             .source = "Annen et al. 2007 (8 bits)",
                             .help = "How a texel keeps its sines and cosines: 16 or 8 bytes for two terms.",
                             .choices = formatNames}};
    Integer terms{*this,
                  {.id = "terms",
                   .label = "Terms of the series",
                   .symbol = "M",
                   .value = 16,
                   .min = 1,
                   .max = mostTerms,
                   .source = "Annen et al. 2007 (16)",
                   .help =
                       "More of them make the step at the receiver steeper, which darkens contacts; memory and time "
                       "grow with them."}};
    Real attenuation{*this,
                     {.id = "attenuation",
                      .symbol = "a",
                      .value = 1,
                      .min = 0,
                      .max = 8,
                      .source = "Annen et al. 2007, section 4.3; exp(−a (k / M)²)",
                      .help = "Weakens the higher terms. Ripples leave stripes of light in shadows; without the higher "
                              "terms the step is less steep and contacts are lighter."}};
    Choice<Shown> shown{*this,
                        {.id = "reconstruction",
                         .value = double(Shown::Doubled),
                         .source = "Annen et al. 2007, section 4.3 (offset and scale)",
                         .help = "The series as it is shades every surface by a half. Doubled: lit surfaces are lit, "
                                 "penumbrae are too light. Bound: never darker than the truth, and never quite dark.",
                         .choices = shownNames}};
    Real margin{*this,
                {.id = "range-margin",
                 .label = "Range margin",
                 .min = 0,
                 .max = 0.5,
                 .unit = Unit::DepthRange,
                 .source = "ours",
                 .help = "The series repeats itself: what lies a whole depth range before a receiver counts half. This "
                         "share of the range stays empty instead.",
                 .defaultFrom = [](const ParameterSet& set) { return std::min(0.5, 1.5 / set.at("terms").value()); }}};
    BiasParameters bias{*this, {.slope = 0.5, .normalOffset = 0.5}};
};

// S(x) of lib/convolution.glsl.
double series(double x, int terms, double attenuation) {
    double sum = 0.5;
    for (int k = 1; k <= terms; ++k) {
        const double c = M_PI * (2 * k - 1), share = double(k) / terms;
        sum += 2 / c * std::exp(-attenuation * share * share) * std::sin(c * x);
    }
    return sum;
}

// V = (S(z − t + x) + y) z, clamped.
glm::vec4 visibilityOfSeries(Shown shown, int terms, double attenuation) {
    if (shown == Shown::Series) return {0, 0, 1, 0};
    if (shown == Shown::Doubled) return {0, 0, 2, 0};
    // The first maximum is moved to the receiver: before it the series is never below what follows, and behind it, by
    // symmetry, never below minus the overshoot.
    const double first = 1.0 / (2 * terms);
    double most = 0, least = 2;
    constexpr int steps = 4096;
    for (int i = 0; i <= steps; ++i) {
        const double x = 0.5 * i / steps, s = series(x, terms, attenuation);
        most = std::max(most, s);
        if (x >= first) least = std::min(least, s);
    }
    least = std::min(least, series(first, terms, attenuation));
    const double overshoot = std::max(most - 1, 0.0);
    return glm::vec4(first, overshoot, 1 / (least + overshoot), 0);
}

class Convolution final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        return parameters_.sampling.reads((parameters_.terms + 1) / 2);
    }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        static constexpr Channel channels[] = {
            {"sin", "sin c₁x", "mean of the sine of the layer's first term", Unit::None, -1, 1},
            {"cos", "cos c₁x", "mean of its cosine", Unit::None, -1, 1},
            {"sin2", "sin c₂x", "mean of the sine of its second term", Unit::None, -1, 1},
            {"cos2", "cos c₂x", "mean of its cosine", Unit::None, -1, 1}};
        static constexpr Format formats[] = {Format::RGBA32F, Format::RGBA16F, Format::RGBA16Snorm};
        const Parameters& p = parameters_;
        const glm::vec2 depth{1 - float(p.margin), 0};
        const MomentMap map = drawMomentMap(flow, scope, inputs,
                                            {.map = p.map.describe(),
                                             .sampling = p.sampling.describe(),
                                             .kernel = p.kernel.kernel,
                                             .sigma = p.kernel.sigma,
                                             .functions = DepthFunctions::SquareWave,
                                             .format = formats[static_cast<size_t>(StoredAs(p.format))],
                                             .layers = (p.terms + 1) / 2,
                                             .depth = depth,
                                             .channels = channels});
        const MomentLookupBlock lookup{.momentsFromStored = glm::mat4(1),
                                       .momentsOffset = glm::vec4(0),
                                       .depth_exponents = glm::vec4(depth, 0, 0),
                                       .range = visibilityOfSeries(p.shown, p.terms, p.attenuation)};
        return resolveMoments(flow, scope, inputs, "techniques/convolution.glsl", map, lookup, p);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card convolutionCard;
const Card convolutionCard{
    .id = "convolution",
    .title = "Convolution shadow maps",
    .authors = "Annen, Mertens, Bekaert, Seidel, Kautz",
    .year = 2007,
    .venue = "EGSR",
    .idea =
        "Write the depth comparison as a Fourier series: its terms are products of functions of either depth, so the "
        "functions of the casting depths can be filtered beforehand.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. Depths "
               "differ by more than the series resolves: about 1 / M of the range.",
    .fails =
        "Contacts are too light over 1 / M of the depth range, ripples leave faint stripes of light in shadows, and "
        "memory and time grow with the terms.",
    .litTolerance = 1e-3,
    .lidTolerance = 0.02,
    .make = [] { return std::unique_ptr<Technique>(new Convolution); },
};

} // namespace penumbra
