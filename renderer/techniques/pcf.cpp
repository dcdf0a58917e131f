// SPDX-License-Identifier: MIT
// Percentage-closer filtering (Reeves, Salesin and Cook, SIGGRAPH 1987): the mean of many comparisons.
//
//     ψ = Σ_k w_k [z_k < z_r(k)] / Σ_k w_k
//
// over the texels k of a kernel around the receiver, z_r(k) the depth of the receiver's own plane at texel k.
// Box and Gaussian of n x n texels: (n + 1)² texture reads a pixel, four to a gather; the bilinear weights are folded
// into the kernel's, which is the same sum as n² hardware 2x2 comparisons. Poisson: as many as there are taps, four
// times that with bilinear comparison.
#include "renderer/core/technique.h"
#include "renderer/shadow_map/poisson_disk.h"
#include "renderer/shadow_map/shadow_map.h"

#include <cmath>
#include <random>

namespace penumbra {
namespace {

constexpr int largestKernel = 63, mostTaps = 64;

enum class Shape { Box, Gaussian, Poisson };
constexpr std::string_view shapeNames[] = {"box", "gaussian", "poisson"};

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this};
    Choice<Shape> shape{*this,
                        {.id = "shape",
                         .label = "Kernel shape",
                         .value = 0,
                         .programConstant = true,
                         .source = "Reeves, Salesin, Cook 1987; Poisson: Mitchell 1991",
                         .help =
                             "Box: every texel counts alike. Gaussian: smoother edges for the same cost. Poisson: a "
                             "few scattered taps, turned from pixel to pixel, trade banding for noise.",
                         .choices = shapeNames}};
    Integer kernel{*this,
                   {.id = "kernel",
                    .label = "Kernel size",
                    .value = 5,
                    .min = 1,
                    .max = largestKernel,
                    .step = 2,
                    .unit = Unit::Texels,
                    .source = "Reeves, Salesin, Cook 1987",
                    .help = "Width of the filter. Softer edges of the same width everywhere; the cost grows with its "
                            "square (Poisson: not at all)."}};
    Real sigma{*this,
               {.id = "sigma",
                .label = "Standard deviation",
                .symbol = "σ",
                .value = 2.4,
                .min = 0.1,
                .max = 32,
                .unit = Unit::Texels,
                .scale = Scale::Logarithmic,
                .source = "Peters and Klein 2015, section 5 (9x9, σ 2.4)",
                .help =
                    "Of the Gaussian. Much below a quarter of the kernel the outer texels are read for nothing; much "
                    "above it the kernel becomes a box.",
                .active = [](const ParameterSet& set) { return set.at("shape").value() == double(Shape::Gaussian); },
                .inactiveReason = "only a Gaussian kernel has it"}};
    Integer taps{*this,
                 {.id = "taps",
                  .label = "Poisson taps",
                  .symbol = "n",
                  .value = 16,
                  .min = 1,
                  .max = mostTaps,
                  .unit = Unit::Samples,
                  .source = "Mitchell 1991",
                  .help = "Comparisons a pixel. More taps, less noise, more time.",
                  .active = [](const ParameterSet& set) { return set.at("shape").value() == double(Shape::Poisson); },
                  .inactiveReason = "only a Poisson kernel has it"}};
    Flag rotate{*this,
                {.id = "rotate",
                 .label = "Turn per pixel",
                 .value = 1,
                 .source = "Uralsky 2005; Jimenez 2014 (noise)",
                 .help = "Turns the Poisson taps by another angle in every pixel: bands become noise.",
                 .active = [](const ParameterSet& set) { return set.at("shape").value() == double(Shape::Poisson); },
                 .inactiveReason = "only a Poisson kernel has it"}};
    Flag bilinear{*this,
                  {.id = "bilinear",
                   .label = "Bilinear comparison",
                   .value = 1,
                   .programConstant = true,
                   .source = "hardware 2x2 comparison",
                   .help = "Blends the comparisons of the four nearest texels, so that edges move smoothly."}};
    ReceiverPlane receiverPlane{*this};
    BiasParameters bias{*this, {.slope = 0.05, .normalOffset = 0.5}};
};

// Box and Gaussian: 1D weights w_0 .. w_n of the texels from the lower left, four to a vector, for the shader to
// combine with the bilinear fractions. Poisson: taps in the unit disk, two to a vector.
constexpr int tableSize = 32;
struct PcfConstants {
    ResolveConstants resolve;
    vec4 table[tableSize];
};

float& entry(PcfConstants& constants, int i) { return constants.table[i / 4][i % 4]; }

void tabulateWeights(const Parameters& p, PcfConstants& constants) {
    const int n = p.kernel;
    float sum = 0;
    const auto weight = [&](int i) {
        const float x = static_cast<float>(i) - 0.5f * static_cast<float>(n - 1);
        return p.shape == Shape::Box ? 1.0f : std::exp(-x * x / (2 * p.sigma * p.sigma));
    };
    for (int i = 0; i < n; ++i) sum += weight(i);
    for (int i = 0; i < n; ++i) entry(constants, i) = weight(i) / sum;
}

class Pcf final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        const int side = parameters_.kernel + 1; // even, for gathers
        const int reads =
            parameters_.shape == Shape::Poisson ? parameters_.taps * (parameters_.bilinear ? 4 : 1) : side * side;
        return TextureReads{reads, reads};
    }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const ShadowMap map = drawShadowMap(flow, scope, inputs, parameters_.map.describe());
        PcfConstants constants{};
        constants.resolve = resolveConstants(inputs, map.view);
        if (parameters_.shape == Shape::Poisson) {
            int i = 0;
            for (const vec2 p : poissonDisk(parameters_.taps)) {
                entry(constants, i++) = p.x;
                entry(constants, i++) = p.y;
            }
        } else {
            tabulateWeights(parameters_, constants);
        }
        return resolve(flow, scope, inputs,
                       {.shader = "techniques/pcf.glsl", .constants = constants, .table = tableSize},
                       {{"shadowMap", map.depth}}, parameters_);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card pcfCard;
const Card pcfCard{
    .id = "pcf",
    .title = "Percentage-closer filtering",
    .authors = "Reeves, Salesin, Cook",
    .year = 1987,
    .venue = "SIGGRAPH",
    .idea =
        "Compare the receiver with many texels around its place on the shadow map and take the mean of the answers.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts.",
    .fails = "Contact shadows are as soft as far ones. The cost grows with the square of the kernel.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-4,
    .make = [] { return std::unique_ptr<Technique>(new Pcf); },
};

} // namespace penumbra
