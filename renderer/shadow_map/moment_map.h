// SPDX-License-Identifier: MIT
// Filterable shadow maps: a shadow map turned into functions of its depths, such as their powers, and filtered by a
// separable Gaussian. One lookup then tells what all depths of a kernel have in common.
#pragma once

#include "renderer/shadow_map/shadow_map.h"

namespace penumbra {

using glm::vec3;
#include "shaders/shared/moments.glsl.h"
static_assert(sizeof(MomentFilterBlock) == 688 && sizeof(MomentLookupBlock) == 272);

inline constexpr double largestMomentMap = 8192; // texels along a side

struct KernelParameters : ParameterGroup {
    explicit KernelParameters(ParameterSet& s) : ParameterGroup(s, "Kernel") {}
    Integer kernel{set,
                   {.id = "kernel",
                    .label = "Kernel size",
                    .value = 9,
                    .min = 1,
                    .max = mostKernel,
                    .step = 2,
                    .unit = Unit::Texels,
                    .source = "Peters and Klein 2015, section 5 (9x9)",
                    .help = "Width of the Gaussian that the map is filtered with. Softer edges of the same width "
                            "everywhere; the cost grows with it for each texel of the map, not for each pixel."}};
    Real sigma{set,
               {.id = "sigma",
                .label = "Standard deviation",
                .symbol = "σ",
                .value = 2.4,
                .min = 0.1,
                .max = 32,
                .unit = Unit::Texels,
                .scale = Scale::Logarithmic,
                .source = "Peters and Klein 2015, section 5 (σ 2.4)",
                .help = "Of the Gaussian. Much below a quarter of the kernel the outer texels are read for nothing; "
                        "much above it the kernel becomes a box.",
                .active = [](const ParameterSet& p) { return p.at("kernel").value() > 1; },
                .inactiveReason = "a kernel of one texel has none"}};
    End end{set};
};

// How many depths a texel has, and how many texels a pixel.
struct MapSampling {
    int samples = 1; // of the shadow map, a texel
    bool mipmaps = false;
    int anisotropy = 1; // samples of the mip chain along the longer axis of a pixel's footprint, at most
};
struct MapSamplingParameters : ParameterGroup {
    explicit MapSamplingParameters(ParameterSet& s) : ParameterGroup(s, "Sampling") {}
    Choice<int> samples{set,
                        {.id = "samples",
                         .label = "Depths a texel",
                         .source = "Peters and Klein 2015, section 5 (4)",
                         .help =
                             "Samples of a multisampled shadow map, each turned into what the map keeps before they "
                             "are averaged. Edges shimmer less; the driver says which counts there are.",
                         .choices = sampleNames}};
    Flag mipmaps{set,
                 {.id = "mipmaps",
                  .label = "Mip chain",
                  .value = 0,
                  .source = "Williams 1983",
                  .help = "Trilinear sampling: where a pixel covers many texels it reads their mean instead of one "
                          "place's. Costs a third more memory; without it far shadows shimmer."}};
    Integer anisotropy{set,
                       {.id = "anisotropy",
                        .value = 1,
                        .min = 1,
                        .max = 16,
                        .unit = Unit::Samples,
                        .source = "Donnelly and Lauritzen 2006",
                        .help = "At most so many samples along the longer axis of a pixel's footprint. Where the view "
                                "grazes a surface shadows are blurred less.",
                        .active = [](const ParameterSet& p) { return p.at("mipmaps").value() != 0; },
                        .inactiveReason = "there is no mip chain"}};
    End end{set};

    MapSampling describe() const { return {1 << samples, mipmaps, anisotropy}; }
    TextureReads reads(int layers = 1) const {
        return {(mipmaps ? 8 : 4) * layers, (mipmaps ? 8 * anisotropy : 4) * layers};
    }
    static constexpr std::string_view sampleNames[] = {"1", "2", "4", "8"};
};

// The slope bias of bounds by four moments: half of the deviation that a kernel, with bilinear sampling, finds in the
// depths of a plane that rises by 1 a texel. At their mean such a bound is up to 0.17 on a lit slope, half a deviation
// before it 0.04 and one deviation before it nothing; contacts leak light in return.
double planeBias(const ParameterSet& set);
double steeperBias(const ParameterSet& set); // 0.75 deviations: sharper bounds leave a plane less far before its mean

enum class MomentFormat { Float32, Float16, Unorm16, Unorm16Optimised };
inline constexpr std::string_view momentFormatNames[] = {"32f", "16f", "unorm16", "unorm16-optimised"};

struct MomentFormatChoice : Choice<MomentFormat> {
    MomentFormatChoice(ParameterSet& set, MomentFormat usual)
        : Choice(set,
                 {.id = "format",
                  .value = double(usual),
                  .source = "Peters and Klein 2015, section 4.3",
                  .help = "How a texel keeps its moments. 32f needs the least bias and twice the memory of the others: "
                          "unorm16-optimised spreads the moments over all of the 16 bits, plain unorm16 and 16f show "
                          "what happens without.",
                  .choices = momentFormatNames}) {}
};

// Which depths the moments are of: z in [0, 1], or 2z − 1 in [−1, 1].
enum class DepthSign { Unsigned, Signed };
inline constexpr std::string_view depthSignNames[] = {"unsigned", "signed"};

// Of techniques that keep powers of the depth.
struct MomentParameters : ParameterGroup {
    MomentParameters(ParameterSet& s, MomentFormat usual, DepthSign usualSign)
        : ParameterGroup(s, "Moments")
        , format{set, usual}
        , depthSign{set,
                    {.id = "depth-range",
                     .label = "Depth range",
                     .value = double(usualSign),
                     .source = "unsigned: Peters and Klein 2015; signed: Peters et al. 2017",
                     .help = "Moments of depths in [0, 1] or in [−1, 1]. The latter are known more exactly, above all "
                             "in the middle, and need less bias.",
                     .choices = depthSignNames}} {}
    MomentFormatChoice format;
    Choice<DepthSign> depthSign;
    End end{set};
};

// Of techniques whose values only floats can hold.
enum class FloatFormat { Float32, Float16 };
struct FloatFormatChoice : Choice<FloatFormat> {
    explicit FloatFormatChoice(ParameterSet& set)
        : Choice(
              set,
              {.id = "format",
               .value = 0,
               .help = "How a texel keeps its values. 16f takes half of the memory and allows much smaller exponents.",
               .choices = names}) {}
    static constexpr std::string_view names[] = {"32f", "16f"};
};
bool isHalf(const ParameterSet& set);

// Of techniques that bound ψ by a mean and a variance.
struct MinimumVariance : Real {
    explicit MinimumVariance(ParameterSet& set, double (*defaultFrom)(const ParameterSet&) = usual)
        : Real(set,
               {.id = "minimum-variance",
                .label = "Minimum variance",
                .symbol = "σ²_min",
                .min = 0,
                .max = 1e-2,
                .scale = Scale::Logarithmic,
                .smallest = 1e-9,
                .source = "Donnelly and Lauritzen 2006",
                .help = "Variances below count as this, in squares of the depth range. Hides rounding on lit surfaces; "
                        "more of it lets light through at contacts.",
                .defaultFrom = defaultFrom}) {}
    static double usual(const ParameterSet& set);
};
struct LightBleedingReduction : Real {
    explicit LightBleedingReduction(ParameterSet& set)
        : Real(set,
               {.id = "bleeding-reduction",
                .label = "Light-bleeding reduction",
                .value = 0,
                .min = 0,
                .max = 0.95,
                .source = "Lauritzen 2007 (GPU Gems 3, chapter 8)",
                .help = "Visibility up to this counts as none and what is above is stretched. Hides light that leaks "
                        "where two casters overlap; thins out penumbrae."}) {}
};

// Of techniques that solve a moment problem of powers.
struct MomentBias : Real {
    explicit MomentBias(ParameterSet& set, double (*defaultFrom)(const ParameterSet&) = usual)
        : Real(set,
               {.id = "moment-bias",
                .label = "Moment bias",
                .symbol = "α",
                .min = 0,
                .max = 1e-2,
                .scale = Scale::Logarithmic,
                .smallest = 1e-8,
                .source = "Peters and Klein 2015, section 4.2 (2e-6 at 32 bits, 3e-5 at 16); signed: Peters et al. "
                          "2017 (3e-7 at 32 bits), ours (3e-5 at 16)",
                .help = "Share of a fixed distribution that is mixed into the moments, so that rounding cannot make "
                        "them impossible. Too little speckles lit surfaces, too much lets light through at contacts.",
                .defaultFrom = defaultFrom}) {}
    static double usual(const ParameterSet& set);
};

// What is stored for a depth x: its powers, four a layer; exp(e1 x); p = exp(e1 x), p², n = −exp(−e2 x), n²; sin and
// cos of 2πx and 4πx; on each layer two terms of a square wave (lib/convolution.glsl); or its place in two of e1 slices
// of the range, which overlap by e2, each with its square (lib/slices.glsl).
enum class DepthFunctions { Powers, Exponential, Exponentials, Trigonometric, SquareWave, Slices };

struct MomentMapDescription {
    ShadowMapDescription map;
    MapSampling sampling = {};
    int kernel = 1;
    float sigma = 1;
    DepthFunctions functions = DepthFunctions::Powers;
    Format format = Format::RGBA32F;
    int layers = 1;            // four functions each
    glm::vec2 depth{1, 0};     // the functions are of depth.x z + depth.y
    glm::vec2 exponents{0, 0}; // e1, e2 of some functions
    // Stored texels are matrix · moments + offset.
    glm::dmat4 storedFromMoments{1};
    glm::dvec4 storedOffset{0};
    std::span<const Channel> channels = {};
};

// Draws the shadow map and filters it: "moments-of-rows", then "moments", larger than the shadow map by half a kernel
// on each side.
struct MomentMap {
    Image moments;
    ShadowMapDescription depths; // one a texel
    MapSampling sampling;
    LightViewBlock view;
    int border;           // half a kernel [texels]
    glm::vec4 weights[8]; // of the kernel
};
MomentMap drawMomentMap(Flow& flow, Scope scope, const Inputs& inputs, const MomentMapDescription& description);

// Map depth times x plus y is the depth whose powers are taken.
glm::vec2 depthScale(DepthSign sign);

// How the first two or four powers are stored: matrix · powers + offset, in [0, 1] for whole numbers.
struct MomentEncoding {
    glm::dmat4 matrix{1};
    glm::dvec4 offset{0};
};
MomentEncoding encodingOf(int count, MomentFormat format, DepthSign sign);

// The first two or four powers as the parameters say, and how they are read with the moment bias α.
MomentMapDescription describePowers(int count, const ShadowMapDescription& map, const MapSampling& sampling,
                                    const KernelParameters& kernel, const MomentParameters& moments);
MomentLookupBlock lookupOfPowers(int count, MomentFormat format, DepthSign sign, double alpha);
inline MomentLookupBlock lookupOfPowers(int count, const MomentParameters& moments, double alpha = 0) {
    return lookupOfPowers(count, moments.format, moments.depthSign, alpha);
}

// So many slices of the depth range (lib/slices.glsl), two moments each.
MomentMapDescription describeSlices(int count, const ShadowMapDescription& map, const MapSampling& sampling,
                                    const KernelParameters& kernel, MomentFormat format, float overlap);
MomentLookupBlock lookupOfSlices(MomentFormat format);

// The pass from a moment map to ψ: a shader that includes moment_lookup.glsl; `withDepths` reads the shadow map as
// well. Where a pixel is probed another pass tells of its kernel, for kernelPlots().
Image resolveMoments(Flow& flow, Scope scope, const Inputs& inputs, std::string_view shader, const MomentMap& map,
                     const MomentLookupBlock& lookup, const ParameterSet& parameters, bool withDepths = false);
std::span<const ProbePlot> kernelPlots();

} // namespace penumbra
