// SPDX-License-Identifier: MIT
// Exponential shadow maps (Annen et al., GI 2008; Salvi 2008): a map of exp(c z), filtered. Where everything in the
// kernel lies at or before the fragment, its mean times exp(−c z_f) is nearly the share that lies at it (Markov's
// inequality).
//
// Values are of z − ½, so that a format's least and greatest number allow twice the exponent. Where the product exceeds
// 1 a surface farther than the fragment's lies in the kernel and the estimate says nothing; the fallback then filters
// the comparisons of the kernel's texels, which only those pixels pay for.
#include "renderer/shadow_map/moment_map.h"

#include <cmath>

namespace penumbra {
namespace {

// The largest c for which neither exp(−c / 2) nor exp(c / 2) leaves the format's range.
double largestExponent(const ParameterSet& set) { return isHalf(set) ? 19.4 : 174; }

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.largest = largestMomentMap}};
    MapSamplingParameters sampling{*this};
    KernelParameters kernel{*this};
    FloatFormatChoice format{*this};
    Real exponent{*this,
                  {.id = "exponent",
                   .label = "Exponent",
                   .symbol = "c",
                   .min = 1,
                   .max = 174,
                   .scale = Scale::Logarithmic,
                   .source = "Annen et al. 2008 (80)",
                   .help = "How steeply a texel loses its say with its distance before the fragment. Too little lets "
                           "light through at contacts, too much makes edges hard on what is not flat.",
                   .defaultFrom = [](const ParameterSet& set) { return isHalf(set) ? 19.0 : 80.0; },
                   .limitFrom = largestExponent,
                   .limitReason = "the largest whose powers the format holds"}};
    Flag fallback{*this,
                  {.id = "fallback",
                   .value = 1,
                   .source = "Annen et al. 2008, section 4",
                   .help = "Compares texel by texel where the estimate cannot hold. Without it light leaks wherever "
                           "something farther than the fragment lies within the kernel."}};
    BiasParameters bias{*this, {.slope = 0.05, .normalOffset = 0.5}};
};

class Esm final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        const int side = parameters_.kernel.kernel + 1; // bilinear
        TextureReads reads = parameters_.sampling.reads();
        if (parameters_.fallback) reads.most += side * side;
        return reads;
    }
    std::span<const ProbePlot> probePlots() const override { return kernelPlots(); }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        static constexpr Channel channels[] = {
            {"exp", "e^c(z − ½)", "mean of the exponential of the depth, c times z − ½"}};
        const Parameters& p = parameters_;
        const MomentMap map = drawMomentMap(flow, scope, inputs,
                                            {.map = p.map.describe(),
                                             .sampling = p.sampling.describe(),
                                             .kernel = p.kernel.kernel,
                                             .sigma = p.kernel.sigma,
                                             .functions = DepthFunctions::Exponential,
                                             .format = isHalf(p) ? Format::R16F : Format::R32F,
                                             .depth = {1, -0.5},
                                             .exponents = {float(p.exponent), 0},
                                             .channels = channels});
        const MomentLookupBlock lookup{.momentsFromStored = glm::mat4(1),
                                       .momentsOffset = glm::vec4(0),
                                       .depth_exponents = glm::vec4(1, -0.5, float(p.exponent), 0),
                                       .range = glm::vec4(-0.5, 0.5, 0, 0)};
        return resolveMoments(flow, scope, inputs, "techniques/esm.glsl", map, lookup, p, true);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card esmCard;
const Card esmCard{
    .id = "esm",
    .title = "Exponential shadow maps",
    .authors = "Annen, Mertens, Seidel, Flerackers, Kautz",
    .year = 2008,
    .venue = "Graphics Interface",
    .idea =
        "Filter an exponential of the depth: its mean, relative to that of the fragment's own depth, is the share of "
        "the kernel that does not shade the fragment.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. Nothing "
               "within the kernel is farther from the light than the fragment.",
    .fails =
        "Contacts are too light by the exponent's gentle slope. Without the fallback light leaks at every edge that "
        "has something farther behind it; with it those pixels cost as much as percentage-closer filtering.",
    .litTolerance = 1e-3,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new Esm); },
};

} // namespace penumbra
