// SPDX-License-Identifier: MIT
// Soft shadows by temporal coherence (Scherzer, Schwärzler, Mattausch, Wimmer, Real-Time Soft Shadows Using Temporal
// Coherence, ISVC 2009; Schwärzler's thesis, TU Wien 2009, chapter 5 and listing). One shadow map a frame, each from
// another point of the light.
//
//   1. shadow map from the next point. The sequence starts over with the history: when the picture's size, the pixel
//      format, a parameter that the history depends on, or the number of things in the scene changes, or on a reset
//   2. resolve: each pixel finds its surface in the last frame's shadow buffer; the same surface keeps ρ and n and adds
//      its test (eq. 5), a new one is marked
//   3. start: what is marked as new begins with an estimate
//   4. filter: what is shown is ψ̂ where its standard error (eq. 3) is small; what is marked asks its neighbours
//
// While something moves there are a second map, from the light's centre, and a search for what moves before the light.
// The buffer holds ρ_n, n, eye depth and mean blocker depth, twice (last frame's and this one's): 32 bytes a pixel in
// 32 bits, 16 in 16. The picture has a margin in it, so that what comes into view has a history.
#include "renderer/core/hash.h"
#include "renderer/core/technique.h"
#include "renderer/shading.h"
#include "renderer/shadow_map/poisson_disk.h"
#include "renderer/shadow_map/shadow_map.h"

#include <algorithm>

namespace penumbra {
namespace {

constexpr int mostTaps = 64;
constexpr int mostMaps = 12;     // a frame: shaders may read 16 images
constexpr int wellSampled = 257; // steps after which one map a frame is enough: the light's centre, and 2^8 points
constexpr int32_t mostHalfs = 2048, mostFloats = 1 << 24; // whole numbers that count without rounding

enum class Sequence { Halton, R2, Random, Sobol };
enum class Start { Pcss, Search, Hard };
enum class Storage { Half, Float };
enum class Lookup { Nearest, Bilinear };
enum class DepthTest { Absolute, Relative };
enum class Moving { Ignore, Disocclusion, Decrement, Region };
enum class Neighbourhood { Off, Box, Poisson };
enum class Footprint { Screen, Surface };
enum class Mixing { Threshold, Blend };
enum class ErrorEstimate { Equation3, Cautious };
constexpr std::string_view sequenceNames[] = {"halton", "r2", "random", "sobol"};
constexpr std::string_view startNames[] = {"pcss", "search", "hard"};
constexpr std::string_view storageNames[] = {"16f", "32f"};
constexpr std::string_view lookupNames[] = {"nearest", "bilinear"};
constexpr std::string_view depthTestNames[] = {"absolute", "relative"};
constexpr std::string_view movingNames[] = {"ignore", "disocclusion", "decrement", "region"};
constexpr std::string_view neighbourhoodNames[] = {"off", "box", "poisson"};
constexpr std::string_view footprintNames[] = {"screen", "surface"};
constexpr std::string_view mixingNames[] = {"threshold", "blend"};
constexpr std::string_view errorNames[] = {"equation-3", "cautious"};

template <class E> bool is(const ParameterSet& set, std::string_view id, E value) {
    return set.at(id).value() == static_cast<double>(value);
}
bool filters(const ParameterSet& set) { return !is(set, "neighbourhood", Neighbourhood::Off); }
constexpr std::string_view filterIsOff = "the neighbourhood filter is off";

constexpr std::string_view filterGroup = "Neighbourhood filter";

// How ψ̂ is shown. Nothing of it is kept, so the history goes on when it is turned.
struct FilterParameters : ParameterGroup {
    explicit FilterParameters(ParameterSet& s) : ParameterGroup(s, filterGroup) {}
    Choice<Neighbourhood> neighbourhood{
        set,
        {.id = "neighbourhood",
         .label = "Filter shape",
         .value = double(Neighbourhood::Poisson),
         .programConstant = true,
         .source = "box: Scherzer 2009, 3.3; Poisson disk: 4",
         .help = "Which neighbours are asked where samples are few. Off shows the samples alone: the truth in the end, "
                 "noise and steps at first.",
         .choices = neighbourhoodNames}};
    Integer taps{set,
                 {.id = "taps",
                  .label = "Neighbours",
                  .value = 8,
                  .min = 1,
                  .max = mostTaps,
                  .unit = Unit::Samples,
                  .source = "Scherzer 2009, 4 (16)",
                  .help = "Texels of the shadow buffer that are averaged. Paid only where the error is large.",
                  .active = filters,
                  .inactiveReason = filterIsOff}};
    Flag thinOut{set,
                 {.id = "thin-out",
                  .label = "Fewer with age",
                  .value = 1,
                  .source = "ours",
                  .help = "Pixels with more than few samples ask fewer neighbours, so that the filter always averages "
                          "about as many samples.",
                  .active = filters,
                  .inactiveReason = filterIsOff}};
    Real radiusScale{set,
                     {.id = "radius-scale",
                      .label = "Radius scale",
                      .value = 0.25,
                      .min = 0,
                      .max = 4,
                      .source = "Scherzer 2009 eq. 6; thesis 5.6, 5.9 to 5.12",
                      .help = "Radius of the filter in half widths of the penumbra. Larger is smoother and makes young "
                              "penumbrae too wide.",
                      .active = filters,
                      .inactiveReason = filterIsOff}};
    Choice<Footprint> footprint{
        set,
        {.id = "footprint",
         .value = double(Footprint::Surface),
         .programConstant = true,
         .source = "screen: Scherzer 2009 eq. 6, thesis 5.9 and 5.10; surface: ours",
         .help = "Screen is a circle of pixels, whatever the surface's tilt. Surface is where the light's shape falls "
                 "on it, and neighbours must lie on its plane.",
         .choices = footprintNames,
         .active = filters,
         .inactiveReason = filterIsOff}};
    Real neighbourEpsilon{set,
                          {.id = "neighbour-epsilon",
                           .label = "Neighbour depth",
                           .symbol = "ε_n",
                           .value = 0.015,
                           .min = 0,
                           .max = 1,
                           .scale = Scale::Logarithmic,
                           .smallest = 1e-5,
                           .source = "thesis, listing (15 · 0.001)",
                           .help = "Difference of depth, as a share of it, up to which a neighbour is of the same "
                                   "surface. Too large blurs over edges, too small leaves slanting surfaces noisy.",
                           .active = filters,
                           .inactiveReason = filterIsOff}};
    Choice<Mixing> mixing{set,
                          {.id = "mixing",
                           .value = double(Mixing::Blend),
                           .programConstant = true,
                           .source = "threshold: Scherzer 2009, 3.3; blend: thesis 5.13, 5.14",
                           .help = "Whether the filter gives way at one error or between two.",
                           .choices = mixingNames,
                           .active = filters,
                           .inactiveReason = filterIsOff}};
    Real threshold{
        set,
        {.id = "threshold",
         .label = "Error threshold",
         .symbol = "t",
         .value = 0.02,
         .min = 0,
         .max = 1,
         .source = "Scherzer 2009, 4 (1/50)",
         .help = "Standard error above which the filter is shown. 1/50 filters the middle of a penumbra for "
                 "627 frames.",
         .active = [](const ParameterSet& set) { return filters(set) && is(set, "mixing", Mixing::Threshold); },
         .inactiveReason = "only mixing by threshold has it"}};
    static bool blends(const ParameterSet& set) { return filters(set) && is(set, "mixing", Mixing::Blend); }
    Real sMin{set,
              {.id = "s-min",
               .label = "Least error",
               .symbol = "s_min",
               .value = 0.05,
               .min = 0,
               .max = 1,
               .source = "thesis 5.13 (1/32; listing 1/50)",
               .help = "Standard error below which the samples alone are shown.",
               .active = blends,
               .inactiveReason = "only mixing by blend has it"}};
    Real sMax{set,
              {.id = "s-max",
               .label = "Most error",
               .symbol = "s_max",
               .value = 0.2,
               .min = 0,
               .max = 1,
               .source = "thesis 5.13 (1/8; listing 1/5)",
               .help = "Standard error above which the filter alone is shown; never below s_min.",
               .active = blends,
               .inactiveReason = "only mixing by blend has it"}};
    Integer fewSamples{set,
                       {.id = "few-samples",
                        .label = "Few samples",
                        .value = 16,
                        .min = 0,
                        .max = 256,
                        .unit = Unit::Samples,
                        .source = "thesis 5.2.4 (16)",
                        .help = "With fewer than these the error itself is not to be trusted, and the filter is shown.",
                        .active = filters,
                        .inactiveReason = filterIsOff}};
    Choice<ErrorEstimate> error{set,
                                {.id = "error",
                                 .label = "Error estimate",
                                 .value = double(ErrorEstimate::Cautious),
                                 .programConstant = true,
                                 .source = "Scherzer 2009 eq. 3; cautious: Laplace's rule",
                                 .help = "Equation 3 is 0 where the first samples agree by chance. The cautious one "
                                         "adds a lit and a shadowed sample first.",
                                 .choices = errorNames,
                                 .active = filters,
                                 .inactiveReason = filterIsOff}};
    Real guided{set,
                {.id = "guided",
                 .label = "Guidance",
                 .value = 0,
                 .min = 0,
                 .max = 1,
                 .source = "thesis 5.2.4 (light and material parameters)",
                 .help = "How far errors count as they are seen: less where ambient light, grazing light or a dark "
                         "colour hide them, so that fewer pixels are filtered. The errors of ψ itself grow.",
                 .active = filters,
                 .inactiveReason = filterIsOff}};
    Flag turn{set,
              {.id = "turn",
               .label = "Turn per pixel",
               .value = 1,
               .source = "Jimenez 2014 (noise)",
               .help = "Other neighbours in every pixel: bands become noise.",
               .active = filters,
               .inactiveReason = filterIsOff}};
    End end{set};
};

struct Parameters : ParameterSet {
    Choice<Sequence> sequence{*this,
                              {.id = "sequence",
                               .value = double(Sequence::Sobol),
                               .source = "halton: Scherzer 2009, 4; r2: Roberts 2018; sobol: Owen 1995",
                               .help = "Order of the light's points. Even ones converge about as n^-3/4, random ones "
                                       "as n^-1/2. Sobol's are evenest where n is a power of two.",
                               .choices = sequenceNames}};
    Choice<Start> start{*this,
                        {.id = "start",
                         .value = double(Start::Pcss),
                         .programConstant = true,
                         .source = "pcss: Scherzer 2009, 3.3; search: thesis 5.2.3; hard: eq. 5 alone",
                         .help = "What a surface without a history begins with: percentage-closer soft shadows as "
                                 "from the light's centre, or one hard test with or without a search for blockers, "
                                 "which the filter needs.",
                         .choices = startNames}};
    static bool searches(const ParameterSet& set) {
        return !is(set, "start", Start::Hard) || is(set, "moving", Moving::Region);
    }
    static bool estimates(const ParameterSet& set) { return is(set, "start", Start::Pcss); }
    Integer startWeight{*this,
                        {.id = "start-weight",
                         .label = "Start's weight",
                         .symbol = "n_0",
                         .value = 4,
                         .min = 1,
                         .max = mostTaps,
                         .unit = Unit::Samples,
                         .scale = Scale::Logarithmic,
                         .source = "Scherzer 2009, 3.3 (1; figure 3: 4)",
                         .help = "How many samples the first estimate counts for. More is calmer at first, and leaves "
                                 "more of the estimate's error behind.",
                         .active = estimates,
                         .inactiveReason = "only a start by pcss has a weight"}};
    Integer searchTaps{*this,
                       {.id = "search-taps",
                        .label = "Search taps",
                        .symbol = "N_b",
                        .value = 16,
                        .min = 1,
                        .max = mostTaps,
                        .unit = Unit::Samples,
                        .source = "Scherzer 2009, 4 (16)",
                        .help = "Texels looked at for blockers where there is no history, and for things that move.",
                        .active = searches,
                        .inactiveReason = "neither a hard start nor the rule for moving casters searches"}};
    Integer filterTaps{*this,
                       {.id = "filter-taps",
                        .label = "Filter taps",
                        .symbol = "N_f",
                        .value = 16,
                        .min = 1,
                        .max = mostTaps,
                        .unit = Unit::Samples,
                        .source = "Scherzer 2009, 4 (16)",
                        .help = "Comparisons averaged over the penumbra where there is no history.",
                        .active = estimates,
                        .inactiveReason = "only a start by pcss compares"}};
    Flag rotate{*this,
                {.id = "rotate",
                 .label = "Shift per pixel",
                 .value = 1,
                 .source = "Cranley and Patterson 1976; Jimenez 2014 (noise)",
                 .help = "Other taps of search and filter in every pixel: bands become noise.",
                 .active = searches,
                 .inactiveReason = "neither a hard start nor the rule for moving casters has taps"}};
    Integer blockerWeight{*this,
                          {.id = "blocker-weight",
                           .label = "Blocker weight",
                           .symbol = "k",
                           .value = 16,
                           .min = 0,
                           .max = 256,
                           .unit = Unit::Samples,
                           .source = "Scherzer 2009 eq. 7; thesis 5.7, 5.8",
                           .help = "How many depths the first blocker depth counts for. It sets the filter's width.",
                           .active = filters,
                           .inactiveReason = filterIsOff}};
    Choice<Storage> storage{*this,
                            {.id = "format",
                             .label = "Buffer format",
                             .value = double(Storage::Float),
                             .source = "16f: Scherzer 2009, 4; 32f: thesis 5.3",
                             .help = "Floats of the shadow buffer. Halfs take half the memory, stop counting at 2048 "
                                     "and know a depth to 1/2000 of it.",
                             .choices = storageNames}};
    Choice<Lookup> lookup{*this,
                          {.id = "lookup",
                           .label = "History lookup",
                           .value = double(Lookup::Bilinear),
                           .programConstant = true,
                           .source = "bilinear: thesis, listing; here each texel has its own depth test",
                           .help = "Nearest is sharp, but slips when the picture moves by parts of a pixel.",
                           .choices = lookupNames}};
    Choice<DepthTest> depthTest{*this,
                                {.id = "depth-test",
                                 .value = double(DepthTest::Relative),
                                 .programConstant = true,
                                 .source = "absolute: Scherzer 2009 eq. 4; relative: thesis 5.18",
                                 .help = "What tells that a pixel shows another surface than in the last frame.",
                                 .choices = depthTestNames}};
    Real epsilonMetres{*this,
                       {.id = "epsilon-metres",
                        .label = "Depth difference",
                        .symbol = "ε",
                        .value = 0.02,
                        .min = 0,
                        .max = 10,
                        .unit = Unit::Metres,
                        .scale = Scale::Logarithmic,
                        .smallest = 1e-5,
                        .source = "Scherzer 2009 eq. 4",
                        .help = "Up to which it is the same surface. Too small loses histories to rounding, too large "
                                "drags shadows along.",
                        .active = [](const ParameterSet& set) { return is(set, "depth-test", DepthTest::Absolute); },
                        .inactiveReason = "only the absolute depth test has it"}};
    Real epsilon{*this,
                 {.id = "epsilon",
                  .label = "Depth difference",
                  .symbol = "ε",
                  .min = 0,
                  .max = 1,
                  .scale = Scale::Logarithmic,
                  .smallest = 1e-5,
                  .source = "thesis 5.18 (listing 0.001)",
                  .help = "Share of the depth up to which it is the same surface. Too small loses histories to "
                          "rounding, too large drags shadows along.",
                  .defaultFrom = [](const ParameterSet& set) { return is(set, "format", Storage::Half) ? 4e-3 : 1e-3; },
                  .active = [](const ParameterSet& set) { return is(set, "depth-test", DepthTest::Relative); },
                  .inactiveReason = "only the relative depth test has it"}};
    Integer mostSamples{*this,
                        {.id = "most-samples",
                         .label = "Most samples",
                         .symbol = "N",
                         .value = mostFloats,
                         .min = 1,
                         .max = mostFloats,
                         .unit = Unit::Samples,
                         .scale = Scale::Logarithmic,
                         .source = "ours",
                         .help = "Where counting stops and the mean stays as it is. Halfs stop at 2048."}};
    Choice<Moving> moving{*this,
                          {.id = "moving",
                           .label = "Moving casters",
                           .value = double(Moving::Region),
                           .programConstant = true,
                           .source = "disocclusion: Scherzer 2009, 3.4; decrement: thesis 5.2.5; region: ours",
                           .help = "What becomes of a history under the shadow of something that moves. Disocclusion "
                                   "starts anew; decrement also takes samples away after the shadow has left. Region "
                                   "looks for things that move before the whole light, and starts anew until the "
                                   "shadow has left; it is searched only in frames in which something moves.",
                           .choices = movingNames}};
    Flag centralMap{*this,
                    {.id = "central-map",
                     .label = "Central map too",
                     .value = 1,
                     .source = "Scherzer 2009, 5 (future work)",
                     .help = "While something moves, a second map a frame, from the light's centre: estimates do not "
                             "jump with the point of the light.",
                     .active = [](const ParameterSet& set) { return !is(set, "start", Start::Hard); },
                     .inactiveReason = "a hard start estimates nothing"}};
    static bool decrements(const ParameterSet& set) { return is(set, "moving", Moving::Decrement); }
    Integer decrement{*this,
                      {.id = "decrement",
                       .symbol = "Δ",
                       .value = 2,
                       .min = 1,
                       .max = mostTaps,
                       .unit = Unit::Samples,
                       .source = "thesis 5.16",
                       .help = "Samples taken away a frame where a moving shadow has been; one is added, too.",
                       .active = decrements,
                       .inactiveReason = "only the rule by decrement has it"}};
    Integer dropAbove{*this,
                      {.id = "drop-above",
                       .label = "Drop above",
                       .value = 6,
                       .min = 0,
                       .max = 256,
                       .unit = Unit::Samples,
                       .source = "thesis, listing (6)",
                       .help = "With more samples than these only Δ are left at once.",
                       .active = decrements,
                       .inactiveReason = "only the rule by decrement has it"}};
    Integer lightMemory{*this,
                        {.id = "light-memory",
                         .label = "Light memory",
                         .value = 8,
                         .min = 0,
                         .max = 256,
                         .unit = Unit::Samples,
                         .source = "Scherzer 2009, 5 and thesis 5.4.1 (future work)",
                         .help = "Samples that are left of a history when the light moves or changes its size, or the "
                                 "surface itself moves. Few follow at once, many trail behind; 0 starts anew."}};
    Integer mapsAtRest{*this,
                       {.id = "maps-at-rest",
                        .label = "Maps at rest",
                        .symbol = "m",
                        .value = 1,
                        .min = 1,
                        .max = mostMaps,
                        .source = "Scherzer 2009 (1)",
                        .help =
                            "Shadow maps a frame, and as many tests, while nothing changes and until there are 256. "
                            "A view at rest is done in fewer, dearer frames."}};
    Real overscan{*this,
                  {.id = "overscan",
                   .value = 5,
                   .min = 0,
                   .max = 50,
                   .unit = Unit::Percent,
                   .source = "Scherzer 2009, 4; thesis 5.3 (5)",
                   .help = "How much larger than the picture the shadow buffer is, so that what comes into view has a "
                           "history."}};
    FilterParameters filter{*this};
    ShadowMapParameters map{*this, {.fit = Fit::View, .size = 1536}};
    ReceiverPlane receiverPlane{*this};
    BiasParameters bias{*this, {.slope = 0, .normalOffset = 0.25}};
};

struct HistoryConstants {
    ResolveConstants resolve;
    vec4 lastX, lastY, lastForward; // from a place relative to the eye [m] to last frame's: d (x, y) [pixels], d [m]
    vec4 lastRayCorner, lastRayDx, lastRayDy; // of last frame's view
    vec4 keep;    // most samples that a history keeps: x in this frame, z if its surface moves; y = that it may have
    vec4 picture; // xy of its first pixel in the buffer
};

struct StillConstants {
    HistoryConstants history;
    struct {
        vec4 sampleReference, window;
    } further[mostMaps - 1]; // of the second map and those after it
};

struct StartConstants {
    ResolveConstants resolve;
    vec4 picture; // as in HistoryConstants
};

struct FilterConstants {
    ResolveConstants resolve;
    vec4 forwardScale;       // xyz the view axis, w = pixels² per m² at eye depth 1; pixels are square
    vec4 probed;             // xy the pixel that is looked at closely
    vec4 taps[mostTaps / 2]; // of the unit disk, two to a vector
};

constexpr Channel bufferChannels[] = {
    {"rho", "ρ", "sum of the hard shadow tests", Unit::Samples},
    {"n", "n", "number of hard shadow tests", Unit::Samples},
    {"depth", "d", "distance along the view axis; negative: in the shadow of something that moved; 0: no surface",
     Unit::Metres},
    {"blocker", "d_b", "mean distance of what blocks, along the light's axis; 0: nothing does", Unit::Metres}};

// Images that only explain: the shaders write them where somebody looks. Numbers of kinds as in the shaders.
constexpr std::string_view eventNames[] = {"no surface",
                                           "history goes on",
                                           "new: was off screen",
                                           "new: another depth",
                                           "new: nothing was there",
                                           "new: a mover's shadow",
                                           "a mover's shadow has left"};
constexpr std::string_view stateNames[] = {"no surface",
                                           "samples alone",
                                           "samples and neighbours",
                                           "neighbours alone",
                                           "new: was off screen",
                                           "new: another depth",
                                           "new: nothing was there",
                                           "new: a mover's shadow",
                                           "a mover's shadow has left"};
constexpr Channel testChannels[] = {
    {"tau", "τ_n",
     "hard shadow test of this frame, a mean where there are several; 1: the point of the light is hidden", Unit::None,
     0, 1},
    {"event", "", "what became of the history in this frame", Unit::None, 0, std::size(eventNames) - 1, eventNames},
    {"light-x", "x", "point of the light that was tested, in half widths from its centre", Unit::None, -1, 1},
    {"light-y", "y", "point of the light that was tested, in half heights from its centre", Unit::None, -1, 1}};
constexpr Channel stateChannels[] = {
    {"state", "", "what is shown, or why the history is new", Unit::None, 0, std::size(stateNames) - 1, stateNames},
    {"filtered", "1 − w", "share of the neighbours' mean in what is shown", Unit::None, 0, 1},
    {"error", "ŝ_n", "standard error of the samples (eq. 3); 1 with fewer than two", Unit::None, 0, 0.5f},
    {"estimate", "ψ̂_n", "mean of the samples, before neighbours are asked", Unit::None, 0, 1}};
constexpr Channel moverChannels[] = {{"moving", "", "1: something that moves takes light", Unit::None, 0, 1}};
constexpr Channel neighbourChannels[] = {
    {"x", "", "of a neighbour that the filter asks, from the probed pixel to the right", Unit::Pixels},
    {"y", "", "upwards", Unit::Pixels},
    {"counted", "", "1: it counts; 0: another surface, or it has no history; −1: nobody was asked", Unit::None, -1, 1}};

constexpr ProbeSeries courseSeries[] = {{"test.tau", "τ_n", ProbeMark::Dots},
                                        {"state.estimate", "ψ̂_n"},
                                        {"state.error", "± ŝ_n", ProbeMark::Band},
                                        {"shadow.psi", "shown"}};
constexpr ProbeSeries lightSeries[] = {{"test.light-x", "x"}, {"test.light-y", "y"}, {"test.tau", "hidden"}};
constexpr ProbeSeries neighbourSeries[] = {
    {"neighbours.x", "x"}, {"neighbours.y", "y"}, {"neighbours.counted", "counted"}};
constexpr ProbePlot plots[] = {
    {ProbePlot::Kind::Course, "ψ over the frames of the history",
     "Each frame's hard test τ, the mean ψ̂ of all of them with its standard error ŝ (eq. 3) to both sides, and ψ as it "
     "is shown, after the neighbourhood filter.",
     courseSeries},
    {ProbePlot::Kind::Places, "Points of the light", "Where on the light each test went to. Filled: hidden.",
     lightSeries},
    {ProbePlot::Kind::Around, "Neighbours", "Whom the filter asks. Filled: the same surface, which counts.",
     neighbourSeries}};

class Temporal final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::span<const ProbePlot> probePlots() const override { return plots; }

    glm::ivec2 margin(glm::ivec2 pictureSize) const override {
        return glm::ivec2(glm::round(glm::vec2(pictureSize) * (parameters_.overscan / 200)));
    }

    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const bool half = parameters_.storage == Storage::Half;
        const ImageSpec buffer{"shadow-buffer", half ? Format::RGBA16F : Format::RGBA32F,
                               Extent{inputs.view.size.x, inputs.view.size.y}, bufferChannels};
        const PastImage past = flow.past(scope, buffer, historyKey(inputs));
        const int32_t most = std::min<int32_t>(parameters_.mostSamples, half ? mostHalfs : mostFloats);
        if (past.steps() >= most + int32_t(parameters_.startWeight) && !moves(inputs)) flow.finish(past);

        const int count = mapsOf(inputs, past);
        flow.advance(past, count);
        const ShadowMap map = drawShadowMap(flow, scope, inputs, describeMap(inputs, past.steps()));
        const glm::ivec2 size = inputs.pictureSize();
        std::optional<ShadowMap> central;
        if (drawsCentre(inputs)) {
            ShadowMapDescription description = parameters_.map.describe();
            signMovers(description);
            central = drawShadowMap(flow, {scope.instance, "temporal-centre"}, inputs, description);
        }
        Frame frame{.map = map,
                    .estimated = central ? *central : map,
                    .past = past,
                    .further = drawFurther(flow, scope, inputs, past.steps() + 1, count - 1),
                    .buffer = buffer,
                    .shadow = {"shadow", Format::R32F, {size.x, size.y}, shadowChannels()}};
        if (parameters_.start != Start::Hard && !stands(inputs, past))
            frame.starting = flow.tiles(scope, "starting", buffer.extent);
        if (filters(parameters_)) {
            frame.asking = flow.tiles(scope, "asking", frame.shadow.extent);
            if (parameters_.filter.guided > 0 && inputs.shading)
                frame.attenuation = drawAttenuation(flow, scope.instance, inputs.view, inputs.light,
                                                    inputs.geometryBuffer, *inputs.shading);
        }

        const Flow::Outputs images = addSample(flow, scope, inputs, frame, most);
        if (frame.starting) start(flow, scope, inputs, frame, images);
        if (frame.asking || inputs.inspection.images) filter(flow, scope, inputs, frame, images);
        return images[1];
    }

private:
    struct Frame {
        const ShadowMap& map;       // from this frame's point of the light
        const ShadowMap& estimated; // what estimates look at
        const PastImage& past;
        FixedVector<ShadowMap, mostMaps - 1> further; // the frame's other maps
        ImageSpec buffer, shadow;
        std::optional<TileSet> starting = {};  // of the buffer: surfaces without a history
        std::optional<TileSet> asking = {};    // of the picture: they ask their neighbours
        std::optional<Image> attenuation = {}; // where what is seen guides the filter
    };

    static bool moves(const Inputs& inputs) { return inputs.geometryBuffer.motion.has_value(); }
    // Every pixel finds its own texel, and no surface is new.
    bool stands(const Inputs& inputs, const PastImage& past) const {
        if (!inputs.last || !past.valid() || moves(inputs)) return false;
        const Real& epsilon =
            parameters_.depthTest == DepthTest::Absolute ? parameters_.epsilonMetres : parameters_.epsilon;
        if (epsilon == 0 || parameters_.moving == Moving::Decrement) return false;
        const View &now = inputs.view, before = grown(inputs.last->view, inputs.margin);
        return now.size == before.size && now.clipFromWorld == before.clipFromWorld && now.rayDx == before.rayDx &&
               now.rayCorner == before.rayCorner && !lightChanged(inputs);
    }
    static bool lightChanged(const Inputs& inputs) {
        if (!inputs.lastLight) return false;
        const AreaLight &now = inputs.light, &before = *inputs.lastLight;
        return now.position != before.position || now.target != before.target || now.size != before.size;
    }
    // A light without a size needs no estimate of what its size does.
    bool estimates(const Inputs& inputs) const {
        return parameters_.start == Start::Pcss && halfSize(inputs.light) != vec2(0);
    }

    // Several where nothing changes, unless somebody watches test by test.
    int mapsOf(const Inputs& inputs, const PastImage& past) const {
        if (!stands(inputs, past) || inputs.inspection.probe) return 1;
        return std::clamp<int>(wellSampled - past.steps(), 1, parameters_.mapsAtRest);
    }

    FixedVector<ShadowMap, mostMaps - 1> drawFurther(Flow& flow, Scope scope, const Inputs& inputs, int step,
                                                     int count) const {
        static constexpr std::string_view owners[] = {"temporal-2",  "temporal-3",  "temporal-4", "temporal-5",
                                                      "temporal-6",  "temporal-7",  "temporal-8", "temporal-9",
                                                      "temporal-10", "temporal-11", "temporal-12"};
        FixedVector<ShadowMap, mostMaps - 1> maps;
        for (int i = 0; i < count; ++i)
            maps.push_back(drawShadowMap(flow, {scope.instance, owners[i]}, inputs, describeMap(inputs, step + i)));
        return maps;
    }

    // The first map is from the light's centre where it serves an estimate.
    ShadowMapDescription describeMap(const Inputs& inputs, int step) const {
        const auto i = static_cast<uint32_t>(step);
        const bool central = step == 0 && estimates(inputs);
        const uint32_t point = estimates(inputs) ? i : i + 1;
        ShadowMapDescription description =
            parameters_.map.describe(central ? lightCentre : lightPoint(inputs.light, samplePoint(inputs.seed, point)));
        if (!central && halfSize(inputs.light) != vec2(0)) { // else it is what other techniques draw, too
            description.shift = parameters_.sequence == Sequence::R2 ? haltonPoint(i + 1) - 0.5f : gridShift(i);
            description.averaged = true;
        }
        if (moves(inputs)) signMovers(description);
        return description;
    }

    void signMovers(ShadowMapDescription& description) const {
        description.signMovers = parameters_.moving != Moving::Ignore;
        if (description.signMovers) description.format = Format::R32F;
    }
    bool drawsCentre(const Inputs& inputs) const {
        return moves(inputs) && parameters_.centralMap && parameters_.start != Start::Hard &&
               halfSize(inputs.light) != vec2(0);
    }

    // The i-th, from 1, under a seed: another one shifts them all, or scrambles otherwise.
    vec2 samplePoint(uint32_t seed, uint32_t i) const {
        if (parameters_.sequence == Sequence::Sobol) return sobolPoint(i - 1, seed);
        const vec2 point = parameters_.sequence == Sequence::Halton ? haltonPoint(i)
                           : parameters_.sequence == Sequence::R2   ? r2Point(i)
                                                                    : randomPoint(i);
        return glm::fract(point + haltonPoint(seed));
    }

    static HistoryConstants historyConstants(const Inputs& inputs, const LightViewBlock& light, float kept,
                                             int32_t most, int memory) {
        const View last = inputs.last ? grown(inputs.last->view, inputs.margin) : inputs.view;
        const glm::dmat3 rays(last.rayDx, last.rayDy, last.rayCorner); // d (x, y, 1) to a place relative to the eye
        const glm::dmat3 fromPlace = glm::inverse(rays);
        const glm::dvec3 moved = fromPlace * (glm::dvec3(inputs.view.eyeWorld) - glm::dvec3(last.eyeWorld));
        const glm::dmat3 rows = glm::transpose(fromPlace);
        const auto row = [&](int i) { return vec4(glm::dvec4(rows[i], moved[i])); };
        return {resolveConstants(inputs, light, true),
                row(0),
                row(1),
                row(2),
                vec4(last.rayCorner, 0),
                vec4(last.rayDx, 0),
                vec4(last.rayDy, 0),
                vec4(kept, most, float(memory), 0),
                vec4(inputs.margin, 0, 0)};
    }

    // The buffer, what its samples say the shadow is and, where somebody looks, the test.
    Flow::Outputs addSample(Flow& flow, Scope scope, const Inputs& inputs, const Frame& frame, int32_t most) const {
        const auto& [map, estimated, past, further, buffer, shadow, starting, asking, attenuation] = frame;
        const float kept = lightChanged(inputs) ? float(parameters_.lightMemory) : float(mostFloats);
        StillConstants constants{historyConstants(inputs, map.view, kept, most, parameters_.lightMemory), {}};
        PassReads reads{{"shadowMap", map.depth}, {"history", past}};
        for (size_t i = 0; i < further.size(); ++i) {
            static constexpr std::string_view names[] = {"furtherMaps[0]", "furtherMaps[1]", "furtherMaps[2]",
                                                         "furtherMaps[3]", "furtherMaps[4]", "furtherMaps[5]",
                                                         "furtherMaps[6]", "furtherMaps[7]", "furtherMaps[8]",
                                                         "furtherMaps[9]", "furtherMaps[10]"};
            constants.further[i] = {further[i].view.sample_reference, further[i].view.window};
            reads.push_back({names[i], further[i].depth});
        }
        Resolver resolver{.shader = "techniques/temporal.glsl",
                          .constants = further.empty() ? Constants(constants.history) : Constants(constants),
                          .writes = buffer.name,
                          .channels = buffer.channels,
                          .format = buffer.format,
                          .withMargin = true,
                          .also = {shadow}};
        if (stands(inputs, past)) resolver.defines.push_back({"STILL"});
        if (starting) resolver.defines.push_back({"STARTED"}), resolver.marks.push_back(*starting);
        if (asking) resolver.defines.push_back({"FILTERED"}), resolver.marks.push_back(*asking);
        if (inputs.inspection.images) {
            resolver.defines.push_back({"INSPECTED"});
            resolver.also.push_back({"test", Format::RGBA16F, buffer.extent, testChannels});
        }
        if (!further.empty()) resolver.defines.push_back({"MAPS", static_cast<int>(further.size()) + 1});
        if (moves(inputs)) {
            resolver.defines.push_back({"MOTION"});
            reads.push_back({"motion", *inputs.geometryBuffer.motion});
            if (parameters_.moving == Moving::Region) {
                resolver.defines.push_back({"MOVERS"});
                reads.push_back({"movers", findMovers(flow, scope, inputs, frame)});
            }
        }
        guide(frame, resolver, reads);
        return resolve(flow, scope, inputs, resolver, reads, parameters_);
    }

    static void guide(const Frame& frame, Resolver& resolver, PassReads& reads) {
        if (!frame.attenuation) return;
        resolver.defines.push_back({"GUIDED"});
        reads.push_back({"attenuation", *frame.attenuation});
    }

    // Estimates what surfaces without a history begin with.
    void start(Flow& flow, Scope scope, const Inputs& inputs, const Frame& frame, const Flow::Outputs& images) const {
        Resolver resolver{.shader = "techniques/temporal_start.glsl",
                          .constants = StartConstants{resolveConstants(inputs, frame.estimated.view, true),
                                                      vec4(inputs.margin, 0, 0)},
                          .pass = "start",
                          .withMargin = true,
                          .onto = {images[0], images[1]},
                          .over = frame.starting};
        if (frame.buffer.format == Format::RGBA16F) resolver.defines.push_back({"HALFS"});
        if (frame.asking) resolver.defines.push_back({"FILTERED"}), resolver.marks.push_back(*frame.asking);
        PassReads reads{{"shadowMap", frame.estimated.depth}};
        if (frame.asking) guide(frame, resolver, reads);
        resolve(flow, scope, inputs, resolver, reads, parameters_);
    }

    // Where something that moves takes light.
    Image findMovers(Flow& flow, Scope scope, const Inputs& inputs, const Frame& frame) const {
        return resolve(flow, scope, inputs,
                       {.shader = "techniques/temporal_movers.glsl",
                        .constants = resolveConstants(inputs, frame.estimated.view, true),
                        .pass = "movers",
                        .writes = "movers",
                        .channels = moverChannels,
                        .format = Format::R16F,
                        .withMargin = true},
                       {{"shadowMap", frame.estimated.depth}}, parameters_);
    }

    void filter(Flow& flow, Scope scope, const Inputs& inputs, const Frame& frame, const Flow::Outputs& images) const {
        const View& view = inputs.view;
        FilterConstants constants{
            resolveConstants(inputs, frame.map.view),
            vec4(glm::normalize(glm::cross(view.rayDy, view.rayDx)), 1 / glm::dot(view.rayDx, view.rayDx)),
            vec4(0),
            {}};
        if (parameters_.filter.neighbourhood == Neighbourhood::Poisson) {
            int i = 0;
            for (const vec2 p : poissonDisk(parameters_.filter.taps)) {
                vec4& pair = constants.taps[i / 2];
                (i % 2 ? pair.z : pair.x) = p.x;
                (i % 2 ? pair.w : pair.y) = p.y;
                ++i;
            }
        }
        Resolver resolver{
            .shader = "techniques/temporal_filter.glsl", .table = mostTaps / 2, .pass = "filter", .onto = {images[1]}};
        PassReads reads{{"shadowBuffer", images[0]}};
        if (inputs.inspection.images) { // of every pixel
            resolver.defines.push_back({"INSPECTED"});
            resolver.also.push_back({"state", Format::RGBA16F, frame.shadow.extent, stateChannels});
            reads.push_back({"test", images[2]});
        } else {
            resolver.over = frame.asking;
        }
        if (inputs.inspection.images && inputs.inspection.probe) {
            constants.probed = vec4(*inputs.inspection.probe, 0, 0);
            resolver.defines.push_back({"PROBED"});
            resolver.also.push_back({"neighbours", Format::RGBA32F, {mostTaps, 1}, neighbourChannels});
        }
        resolver.constants = constants;
        guide(frame, resolver, reads);
        resolve(flow, scope, inputs, resolver, reads, parameters_);
    }

    // Of all that makes a history worthless. The light may move and things may, within the rules for them.
    uint64_t historyKey(const Inputs& inputs) const {
        Hash hash;
        hash.add(inputs.light.shape);
        hash.add(static_cast<uint64_t>(inputs.occluders.size()));
        hash.add(inputs.seed);
        for (const Parameter* parameter : parameters_.all())
            if (parameter->group() != filterGroup) hash.add(parameter->bits());
        return hash.value();
    }

    Parameters parameters_;
};

} // namespace

extern const Card temporalCard;
const Card temporalCard{
    .id = "temporal",
    .title = "Soft shadows by temporal coherence",
    .authors = "Scherzer, Schwärzler, Mattausch, Wimmer",
    .year = 2009,
    .venue = "ISVC",
    .idea = "Draw one shadow map a frame, each from another point of the light, and keep for every surface on screen "
            "the mean of its hard shadow tests. Where there are few of them, estimate by percentage-closer soft "
            "shadows and filter over the neighbours.",
    .assumes = "Most of what is seen was seen in the last frame, and what casts on it stood still.",
    .fails = "Shadows of moving things are estimates and may flicker or trail. A moving light never converges. What "
             "comes into view begins anew.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-4,
    .make = [] { return std::unique_ptr<Technique>(new Temporal); },
};

} // namespace penumbra
