// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows (Fernando, SIGGRAPH sketch 2005), as the 2009 paper and the thesis judge themselves
// against (Scherzer et al. 2009 eq. 6, figure 4).
//
//   1. blocker search: mean depth d_b of the texels in front of the receiver's plane, over the region through which the
//      receiver sees the light past the nearest caster
//   2. penumbra: half size on the reference plane r f (1/d_b − 1/d_r), directional r (d_r − d_b)
//   3. percentage-closer filter over that region
//
// Region and filter have the shape of the light: a lattice for a rectangle, a spiral for a disk. The search may be
// denser towards its centre (an offset o becomes o |o|). Exact for a light, one blocker depth and a receiver that are
// parallel. N_b + N_f texture reads a pixel; N_b where nothing blocks.
#include "renderer/core/technique.h"
#include "renderer/shadow_map/shadow_map.h"

namespace penumbra {
namespace {

constexpr int mostTaps = 64;

enum class Search { Centred, Uniform };
constexpr std::string_view searchNames[] = {"centred", "uniform"};

struct Parameters : ParameterSet {
    ShadowMapParameters map{*this, {.fit = Fit::View}};
    Integer searchTaps{*this,
                       {.id = "search-taps",
                        .label = "Search taps",
                        .symbol = "N_b",
                        .value = 16,
                        .min = 1,
                        .max = mostTaps,
                        .unit = Unit::Samples,
                        .source = "Fernando 2005; Scherzer 2009 figure 4 (16, 32)",
                        .help =
                            "Texels looked at for blockers. Too few miss thin casters and make the width noisy; this "
                            "is the cost of every lit pixel."}};
    Choice<Search> search{*this,
                          {.id = "search",
                           .label = "Search density",
                           .value = 0,
                           .programConstant = true,
                           .source = "uniform: Fernando 2005; centred: ours",
                           .help = "Where the search looks. A blocker near the receiver hides the light only within a "
                                   "small region around it, so taps that are denser at the centre miss few contacts; "
                                   "uniform ones lose them where the light is large.",
                           .choices = searchNames}};
    Integer filterTaps{*this,
                       {.id = "filter-taps",
                        .label = "Filter taps",
                        .symbol = "N_f",
                        .value = 16,
                        .min = 1,
                        .max = mostTaps,
                        .unit = Unit::Samples,
                        .source = "Fernando 2005; Scherzer 2009 figure 4 (16, 32)",
                        .help = "Comparisons averaged over the penumbra. Fewer leave noise or bands in wide penumbrae; "
                                "paid only where something blocks."}};
    LightScale lightScale{*this};
    Flag rotate{*this,
                {.id = "rotate",
                 .label = "Shift per pixel",
                 .value = 1,
                 .source = "Cranley and Patterson 1976; Jimenez 2014 (noise)",
                 .help = "Shifts or turns the taps differently in every pixel: bands become noise."}};
    ReceiverPlane receiverPlane{*this};
    BiasParameters bias{*this, {.slope = 0.05, .normalOffset = 0.25}};
};

class Pcss final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        return TextureReads{parameters_.searchTaps, parameters_.searchTaps + parameters_.filterTaps};
    }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const ShadowMap map = drawShadowMap(flow, scope, inputs, parameters_.map.describe());
        return resolve(flow, scope, inputs,
                       {.shader = "techniques/pcss.glsl", .constants = resolveConstants(inputs, map.view)},
                       {{"shadowMap", map.depth}}, parameters_);
    }

private:
    Parameters parameters_;
};

} // namespace

extern const Card pcssCard;
const Card pcssCard{
    .id = "pcss",
    .title = "Percentage-closer soft shadows",
    .authors = "Fernando",
    .year = 2005,
    .venue = "SIGGRAPH sketches",
    .idea = "Search for what blocks the light, take the penumbra's width from its mean depth by similar triangles, and "
            "filter the comparisons over that width.",
    .assumes =
        "Light, blocker and receiver are parallel, and all blockers of a point lie at one depth. One map, from the "
        "light's centre.",
    .fails = "Overlapping blockers at several depths give one wrong width; few taps leave bands or noise in large "
             "penumbrae; what the centre of the light does not see casts nothing.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-4,
    .make = [] { return std::unique_ptr<Technique>(new Pcss); },
};

} // namespace penumbra
