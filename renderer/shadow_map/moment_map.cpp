// SPDX-License-Identifier: MIT
#include "renderer/shadow_map/moment_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra {
namespace {

using glm::dmat4;
using glm::dvec4;

// Weights of the centre and of those beside it on one side; all, on both sides, sum to 1.
struct Gaussian {
    int half;
    double weights[mostKernel / 2 + 1] = {};
    Gaussian(int kernel, double sigma) : half(kernel / 2) {
        double sum = 0;
        for (int i = 0; i <= half; ++i) {
            weights[i] = std::exp(-i * i / (2 * sigma * sigma));
            sum += (i == 0 ? 1 : 2) * weights[i];
        }
        for (double& w : weights) w /= sum;
    }
    double variance() const {
        double sum = 0;
        for (int i = 1; i <= half; ++i) sum += 2 * weights[i] * i * i;
        return sum;
    }
};

dmat4 fromRows(dvec4 a, dvec4 b, dvec4 c, dvec4 d) { return glm::transpose(dmat4(a, b, c, d)); }

// From [−1, 1] to [0, 1] for odd powers.
const MomentEncoding signedPlain{fromRows({0.5, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0.5, 0}, {0, 0, 0, 1}),
                                 {0.5, 0, 0.5, 0}};

// θ2 and θ4 of Peters and Klein 2015, section 4.3: of all affine maps of the moment curve into the unit cube those of
// the greatest determinant, 2² and 2^12.28.
const MomentEncoding theta2{fromRows({1, 0, 0, 0}, {4, -4, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}), dvec4(0)};
const MomentEncoding theta4{
    fromRows({-2.07224649, 32.2370378, -68.5710746, 39.3703274}, {13.7948857, -59.4683976, 82.035975, -35.3649032},
             {0.105877704, -1.90774663, 9.34965551, -6.65434907}, {9.79240621, -33.76521106, 47.9456097, -23.9728048}),
    {0.0359558848, 0, 0, 0}};
// Peters et al. 2017, of moments in [−1, 1]: odd and even powers apart. Two of them are stored at their best as they
// are.
const double root3 = std::sqrt(3.0);
const MomentEncoding signedTheta4{
    fromRows({1.5, 0, -2, 0}, {0, 4, 0, -4}, {root3 / 2, 0, -2 * root3 / 9, 0}, {0, 0.5, 0, 0.5}), {0.5, 0, 0.5, 0}};

// Two moments of either of two slices.
MomentEncoding slicesEncoding(MomentFormat format) {
    MomentEncoding both = encodingOf(2, format, DepthSign::Unsigned);
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column) both.matrix[column + 2][row + 2] = both.matrix[column][row];
    return both;
}

Format textureFormat(int count, MomentFormat format) {
    switch (format) {
    case MomentFormat::Float32: return count == 2 ? Format::RG32F : Format::RGBA32F;
    case MomentFormat::Float16: return count == 2 ? Format::RG16F : Format::RGBA16F;
    case MomentFormat::Unorm16:
    case MomentFormat::Unorm16Optimised: return count == 2 ? Format::RG16 : Format::RGBA16;
    }
    return {};
}

// The moments that the moment bias mixes in, and what their distribution leaves of D22 and D33 where there is but a
// single surface. With two atoms at the ends of [0, 1] that is, of D33, up to 1/16 in the middle and 0 at the ends,
// where rounding would decide: an eighth of it is kept.
struct BiasTarget {
    dvec4 moments;
    double variance, pivot;
};

BiasTarget biasTarget(MomentFormat format, DepthSign sign) {
    if (sign == DepthSign::Unsigned) return {dvec4(0.5), 0.25, 1.0 / 128};
    const double even = format == MomentFormat::Float32 ? 0.375 : 0.628;
    return {{0, even, 0, even}, even, even * (1 - even)};
}

double planeDeviation(const ParameterSet& set) {
    const Gaussian gaussian(static_cast<int>(set.at("kernel").value()), set.at("sigma").value());
    constexpr double bilinear = 0.25; // variance at most
    return std::sqrt(gaussian.variance() + bilinear);
}

} // namespace

glm::vec2 depthScale(DepthSign sign) { return sign == DepthSign::Signed ? glm::vec2(2, -1) : glm::vec2(1, 0); }

MomentEncoding encodingOf(int count, MomentFormat format, DepthSign sign) {
    const bool isSigned = sign == DepthSign::Signed;
    switch (format) {
    case MomentFormat::Float32:
    case MomentFormat::Float16: return {};
    case MomentFormat::Unorm16: return isSigned ? signedPlain : MomentEncoding{};
    case MomentFormat::Unorm16Optimised:
        if (count == 2) return isSigned ? signedPlain : theta2;
        return isSigned ? signedTheta4 : theta4;
    }
    return {};
}

double planeBias(const ParameterSet& set) { return 0.5 * planeDeviation(set); }
double steeperBias(const ParameterSet& set) { return 0.75 * planeDeviation(set); }

bool isHalf(const ParameterSet& set) { return set.at("format").value() == double(FloatFormat::Float16); }

double MinimumVariance::usual(const ParameterSet& set) {
    switch (static_cast<MomentFormat>(static_cast<int>(set.at("format").value()))) {
    case MomentFormat::Float32: return 1e-6;
    case MomentFormat::Float16: return 1e-3;
    case MomentFormat::Unorm16:
    case MomentFormat::Unorm16Optimised: return 1e-5;
    }
    return 0;
}

double MomentBias::usual(const ParameterSet& set) {
    const auto format = static_cast<MomentFormat>(static_cast<int>(set.at("format").value()));
    const auto sign = static_cast<DepthSign>(static_cast<int>(set.at("depth-range").value()));
    // Those of docs/moments.md at which no bound was above the truth. At 16 bits signed depths of the same bias are
    // nearer to what exact moments give; the 6e-5 of Peters et al. 2017 cost more light than variance loses at 32 bits.
    if (format == MomentFormat::Float32) return sign == DepthSign::Signed ? 3e-7 : 2e-6;
    return 3e-5;
}

MomentMapDescription describePowers(int count, const ShadowMapDescription& map, const MapSampling& sampling,
                                    const KernelParameters& kernel, const MomentParameters& moments) {
    static constexpr Channel channels[] = {{"b1", "b₁", "mean of the depth, as the format stores it"},
                                           {"b2", "b₂", "mean of its square"},
                                           {"b3", "b₃", "mean of its third power"},
                                           {"b4", "b₄", "mean of its fourth power"}};
    const MomentEncoding stored = encodingOf(count, moments.format, moments.depthSign);
    return {.map = map,
            .sampling = sampling,
            .kernel = kernel.kernel,
            .sigma = kernel.sigma,
            .format = textureFormat(count, moments.format),
            .depth = depthScale(moments.depthSign),
            .storedFromMoments = stored.matrix,
            .storedOffset = stored.offset,
            .channels = std::span(channels).first(static_cast<size_t>(count))};
}

MomentLookupBlock lookupOfPowers(int count, MomentFormat format, DepthSign sign, double alpha) {
    const MomentEncoding stored = encodingOf(count, format, sign);
    const BiasTarget target = biasTarget(format, sign);
    const dmat4 inverse = (1 - alpha) * glm::inverse(stored.matrix);
    // Below this a float's rounding says more than the moments.
    constexpr double leastVariance = 1e-7, leastPivot = 1e-9;
    return {.momentsFromStored = glm::mat4(inverse),
            .momentsOffset = glm::vec4(alpha * target.moments - inverse * stored.offset),
            .depth_exponents = glm::vec4(depthScale(sign), 0, 0),
            .range = glm::vec4(sign == DepthSign::Signed ? -1 : 0, 1, std::max(alpha * target.variance, leastVariance),
                               std::max(alpha * target.pivot, leastPivot))};
}

MomentMapDescription describeSlices(int count, const ShadowMapDescription& map, const MapSampling& sampling,
                                    const KernelParameters& kernel, MomentFormat format, float overlap) {
    static constexpr Channel channels[] = {{"b1", "b₁", "mean of the place in the layer's first slice, as stored"},
                                           {"b2", "b₂", "mean of its square"},
                                           {"c1", "c₁", "mean of the place in its second slice"},
                                           {"c2", "c₂", "mean of its square"}};
    const MomentEncoding stored = slicesEncoding(format);
    return {.map = map,
            .sampling = sampling,
            .kernel = kernel.kernel,
            .sigma = kernel.sigma,
            .functions = DepthFunctions::Slices,
            .format = textureFormat(4, format),
            .layers = (count + 1) / 2,
            .exponents = {static_cast<float>(count), overlap},
            .storedFromMoments = stored.matrix,
            .storedOffset = stored.offset,
            .channels = channels};
}

MomentLookupBlock lookupOfSlices(MomentFormat format) {
    const MomentEncoding stored = slicesEncoding(format);
    const dmat4 inverse = glm::inverse(stored.matrix);
    return {.momentsFromStored = glm::mat4(inverse),
            .momentsOffset = glm::vec4(-(inverse * stored.offset)),
            .depth_exponents = glm::vec4(1, 0, 0, 0),
            .range = glm::vec4(0, 1, 0, 0)};
}

MomentMap drawMomentMap(Flow& flow, Scope scope, const Inputs& inputs, const MomentMapDescription& description) {
    const Gaussian gaussian(description.kernel, description.sigma);
    ShadowMapDescription several = description.map;
    several.samples = description.sampling.samples;
    const ShadowMap map = drawShadowMap(flow, scope, inputs, several);

    MomentFilterBlock block{.storedFromMoments = glm::mat4(description.storedFromMoments),
                            .storedOffset = glm::vec4(description.storedOffset),
                            .depth_exponents = glm::vec4(description.depth, description.exponents),
                            .kernel = {gaussian.half, 0, 0, 0},
                            .weights = {}};
    for (int i = 0; i <= gaussian.half; ++i) block.weights[i].x = static_cast<float>(gaussian.weights[i]);
    const int size = description.map.size, wider = size + 2 * gaussian.half;
    const bool encoded = description.storedFromMoments != dmat4(1) || description.storedOffset != dvec4(0);
    const auto filter = [&](std::string_view name, Image source, bool fromDepth, bool rows) {
        Compute work{"moment_map.glsl", {}};
        if (fromDepth) work.defines.push_back({"FROM_DEPTH"});
        if (fromDepth) work.defines.push_back({"FUNCTIONS", static_cast<int>(description.functions)});
        if (fromDepth && encoded) work.defines.push_back({"ENCODED"});
        if (fromDepth && several.samples > 1) work.defines.push_back({"SAMPLES", several.samples});
        if (rows) work.defines.push_back({"ROWS"});
        if (description.layers > 1) work.defines.push_back({"LAYERED"});
        Extent extent{wider, rows ? size : wider, description.layers};
        if (description.sampling.mipmaps && !rows) extent.levels = static_cast<int>(std::bit_width(unsigned(wider)));
        return Image(flow.pass(scope, {.stage = Stage::Prefilter,
                                       .name = name,
                                       .work = work,
                                       .reads = {{"source", source}},
                                       .writes = {{name, description.format, extent, description.channels}},
                                       .constants = block}));
    };
    const bool wide = gaussian.half > 0;
    const Image source = wide ? filter("moments-of-rows", map.depth, true, true) : map.depth;
    MomentMap result{
        filter("moments", source, !wide, false), description.map, description.sampling, map.view, gaussian.half, {}};
    for (int i = 0; i <= gaussian.half; ++i) result.weights[i / 4][i % 4] = block.weights[i].x;
    return result;
}

namespace {

constexpr Channel depthChannels[] = {
    {"z", "z", "depth", Unit::DepthRange},
    {"share", "F", "share of the kernel in front of that depth", Unit::None, 0, 1},
    {"fragment", "z_f", "depth of the probed pixel's surface, biased", Unit::DepthRange},
    {"convolution", "", "series of 16 terms of the comparison", Unit::None, 0, 1}};
constexpr Channel boundChannels[] = {{"variance", "", "least share by two moments", Unit::None, 0, 1},
                                     {"hamburger", "", "by four moments", Unit::None, 0, 1},
                                     {"hausdorff", "", "by four moments of depths in the range", Unit::None, 0, 1},
                                     {"six", "", "by six moments", Unit::None, 0, 1}};
constexpr Channel warpChannels[] = {{"trigonometric", "", "least share by two sines and cosines", Unit::None, 0, 1},
                                    {"exponential", "", "by an exponential, c = 80", Unit::None, 0, 1},
                                    {"evsm", "", "by the moments of two exponentials, c = 40 and 5", Unit::None, 0, 1},
                                    {"layered", "", "by two moments of each of four slices", Unit::None, 0, 1}};

constexpr Channel ownChannels[] = {{"psi", "ψ", "what the technique makes of its map at that depth", Unit::None, 0, 1}};

constexpr ProbeSeries kernelSeries[] = {{"kernel-depths.z", "z"},
                                        {"kernel-depths.share", "F(z), the kernel", ProbeMark::Step},
                                        {"kernel-depths.fragment", "z_f, the fragment", ProbeMark::Upright},
                                        {"kernel-own.psi", "ψ, as it is set", ProbeMark::Heavy},
                                        {"kernel-bounds.variance", "variance"},
                                        {"kernel-bounds.hamburger", "four moments"},
                                        {"kernel-bounds.hausdorff", "four, in the range"},
                                        {"kernel-bounds.six", "six moments"},
                                        {"kernel-warps.trigonometric", "trigonometric"},
                                        {"kernel-warps.exponential", "exponential"},
                                        {"kernel-warps.evsm", "exponential variance"},
                                        {"kernel-warps.layered", "layered variance"},
                                        {"kernel-depths.convolution", "convolution", ProbeMark::Dashed}};

// Of the kernel around one pixel, from the depths themselves: "kernel-depths" and the curves over them.
Image probeKernel(Flow& flow, Scope scope, const Inputs& inputs, Constants constants, const MomentMap& map,
                  const ParameterSet& parameters) {
    const Image depths = drawShadowMap(flow, scope, inputs, map.depths).depth;
    const Extent row{probeColumns, 1};
    return flow.pass(scope, {.stage = Stage::Resolve,
                             .name = "kernel-probe",
                             .work = Compute{"moment_probe.glsl", resolveDefines(inputs.light)},
                             .reads = {{"depth", inputs.geometryBuffer.depth},
                                       {"normal", inputs.geometryBuffer.normal},
                                       {"shadowMap", depths}},
                             .writes = {{"kernel-depths", Format::RGBA32F, row, depthChannels},
                                        {"kernel-bounds", Format::RGBA32F, row, boundChannels},
                                        {"kernel-warps", Format::RGBA32F, row, warpChannels}},
                             .constants = constants,
                             .parameters = &parameters})[0];
}

} // namespace

std::span<const ProbePlot> kernelPlots() {
    static constexpr ProbePlot plots[] = {
        {ProbePlot::Kind::Curves, "The kernel's depths",
         "What share of the kernel lies in front of a depth. Heavy: what this technique makes of it, from its own map "
         "and as it is set. Thin: what every member of the family makes of its means of the same depths, kept as "
         "32-bit floats, with textbook values. Solid: never above F. Where a curve crosses the fragment's line is its "
         "ψ.",
         kernelSeries, "Depth z", "ψ"}};
    return plots;
}

void resolveProbed(Flow& flow, Scope scope, const Inputs& inputs, Resolver resolver, const Constants& constants,
                   PassReads reads, Image depths, const ParameterSet& parameters) {
    resolver.defines.push_back({"AT_ALL_DEPTHS"});
    resolver.constants = constants;
    resolver.pass = resolver.writes = "kernel-own";
    resolver.channels = ownChannels;
    resolver.extent = {probeColumns, 1};
    reads.push_back({"kernelDepths", depths});
    resolve(flow, scope, inputs, resolver, reads, parameters);
}

Image resolveMoments(Flow& flow, Scope scope, const Inputs& inputs, std::string_view shader, const MomentMap& map,
                     const MomentLookupBlock& lookup, const ParameterSet& parameters, bool withDepths) {
    struct Block {
        ResolveConstants resolve;
        MomentLookupBlock lookup;
    } block{resolveConstants(inputs, map.view), lookup};
    block.lookup.border_perTexel = {map.border, 1.0f / static_cast<float>(flow.spec(map.moments).extent.width), 0, 0};
    std::copy(std::begin(map.weights), std::end(map.weights), block.lookup.weights);
    Resolver resolver{.shader = shader, .constants = block};
    if (const int layers = flow.spec(map.moments).extent.layers; layers > 1) resolver.defines.push_back({"LAYERED"});
    Read moments{"moments", map.moments, Sampling::Linear};
    if (map.sampling.mipmaps) {
        resolver.defines.push_back({"MIPMAPPED"});
        moments.sampling = Sampling::LinearMipmap;
        moments.anisotropy = map.sampling.anisotropy;
    }
    PassReads reads{moments};
    if (withDepths) reads.push_back({"shadowMap", drawShadowMap(flow, scope, inputs, map.depths).depth});
    if (inputs.inspection.probe) {
        Block probed = block;
        probed.lookup.probed = {*inputs.inspection.probe, map.border, 0};
        const Image depths = probeKernel(flow, scope, inputs, probed, map, parameters);
        resolveProbed(flow, scope, inputs, resolver, probed, reads, depths, parameters);
    }
    return resolve(flow, scope, inputs, resolver, reads, parameters);
}

} // namespace penumbra
