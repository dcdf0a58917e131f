// SPDX-License-Identifier: MIT
// Fractional-disk soft shadows (Valient and de Boer, Fractional-Disk Soft Shadows, ShaderX4, 2006). The share of an
// area light that a point sees is taken for the share of a disk around the point that the light's centre sees.
//
//   1. shadow map of the faces turned away from the light (second depth), of the distance to the light's centre
//   2. pre-processing: each texel of the map learns the depth of the nearest occluder and the inverse distance to the
//      nearest hard boundary, up to a largest radius of n texels. As published: an edge filter and n passes of 3x3
//      texels; or the same in two passes of 2 n + 1; or jump flooding (Rong and Tan 2006) in log2 n + 2
//   3. resolve: disk radius q = r d2 / d1 (eq. 1) from the pixel's own occluder or, where it is lit, the nearest one;
//      pixels whose disk reaches no boundary are done; the others take f(q) = ⌈π q² / a⌉ samples (eq. 2) of the disk
//
// The disk is of the light's shape, so that a rectangular light has a rectangle; a directional light's radius is
// d2 tan α. Exact for a light, an occluder and a receiver that are parallel. Memory: 4 bytes a texel of the map, and 40
// to 48 more with pre-processing; 2 reads of the map a pixel that is not filtered.
#include "renderer/core/hash.h"
#include "renderer/core/technique.h"
#include "renderer/shadow_map/poisson_disk.h"
#include "renderer/shadow_map/shadow_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

namespace penumbra {
namespace {

constexpr int largestRadius = 256, mostSamples = 256;
constexpr int pointsInSet = 64; // of a row of the noise map and of the constants
constexpr int noiseRows = 32;
constexpr int filterTaps = 32;   // vectors of two
constexpr int mostFrames = 4096; // that are accumulated; 256 samples each are whole numbers in a float still

enum class Preparation { Flood, Separable, Published, None, NoneCorrected };
enum class Noise { RandomStart, Interpolated, OneDimensional, Constants };
enum class TwoStep { Off, Outer, Everywhere };
enum class Listing { Corrected, Noise, EarlyOut, Sum, Distance, AsPrinted };
enum class Distance { Fragment, Vertex, Axial };
constexpr std::string_view preparationNames[] = {"flood", "separable", "published", "none", "none-corrected"};
constexpr std::string_view noiseNames[] = {"random-start", "interpolated", "one-dimensional", "constants"};
constexpr std::string_view twoStepNames[] = {"off", "outer", "everywhere"};
constexpr std::string_view listingNames[] = {"corrected", "noise", "early-out", "sum", "distance", "as-printed"};
constexpr std::string_view distanceNames[] = {"fragment", "vertex", "axial"};

bool prepares(const ParameterSet& set) { return set.at("pre-processing").value() < double(Preparation::None); }
bool radial(const ParameterSet& set) { return set.at("distance").value() != double(Distance::Axial); }

struct Parameters : ParameterSet {
    Choice<Preparation> preparation{
        *this,
        {.id = "pre-processing",
         .label = "Pre-processing",
         .value = double(Preparation::Flood),
         .programConstant = true,
         .source =
             "published: Valient, de Boer, figure 5; separable: their Optimizations; flood: Rong, Tan 2006; none: "
             "their Implementation without preprocessing",
         .help = "How texels learn of the nearest occluder and boundary. Published takes a pass for each texel of the "
                 "radius, separable two long ones, flood a few. None guesses a texel's radius for lit pixels; "
                 "corrected none searches for it.",
         .choices = preparationNames}};
    Integer maxRadius{*this,
                      {.id = "max-radius",
                       .label = "Largest radius",
                       .value = 64,
                       .min = 1,
                       .max = largestRadius,
                       .unit = Unit::Texels,
                       .scale = Scale::Logarithmic,
                       .source = "Valient, de Boer (17 passes)",
                       .help = "Disks are no larger than this, so that wide penumbrae come out too narrow. Published "
                               "pre-processing takes as many passes."}};
    Real edgeThreshold{*this,
                       {.id = "edge-threshold",
                        .label = "Edge threshold",
                        .value = 0.003,
                        .min = 0,
                        .max = 1,
                        .unit = Unit::DepthRange,
                        .scale = Scale::Logarithmic,
                        .smallest = 1e-6,
                        .source = "Valient, de Boer (an edge detection filter)",
                        .help = "Bend of depth from texel to texel that is a hard boundary. Too large loses the "
                                "penumbrae of low steps, too small filters where nothing is.",
                        .active = prepares,
                        .inactiveReason = "only pre-processing looks for edges"}};
    Real texelsPerSample{*this,
                         {.id = "texels-per-sample",
                          .label = "Texels per sample",
                          .symbol = "a",
                          .value = 2,
                          .min = 0.05,
                          .max = 64,
                          .unit = Unit::Texels,
                          .scale = Scale::Logarithmic,
                          .source = "Valient, de Boer eq. 2, figure 2 (2)",
                          .help = "Texels of the disk for each of its samples. Fewer samples are faster and noisier."}};
    Integer maxSamples{
        *this,
        {.id = "max-samples",
         .label = "Most samples",
         .symbol = "N",
         .value = 64,
         .min = 1,
         .max = mostSamples,
         .unit = Unit::Samples,
         .scale = Scale::Logarithmic,
         .source = "Valient, de Boer (5 passes of 10)",
         .help = "Samples of a disk, however large it is. Wide penumbrae show as many steps, or noise."}};
    Real samplesPerPixel{*this,
                         {.id = "samples-per-pixel",
                          .label = "Limit per pixel",
                          .value = 0,
                          .min = 0,
                          .max = 4,
                          .unit = Unit::Samples,
                          .scale = Scale::Logarithmic,
                          .smallest = 1e-3,
                          .source = "Valient, de Boer, Optimizations (fewer samples farther from the viewer)",
                          .help = "Disks that are far from the viewer take no more samples than this for each pixel of "
                                  "their area on the screen, which falls with the square of the distance. 0: no "
                                  "limit, all of eq. 2."}};
    Choice<Noise> noise{*this,
                        {.id = "noise",
                         .value = double(Noise::RandomStart),
                         .programConstant = true,
                         .source = "Valient, de Boer, Noise map generation, Final rendering, Optimizations",
                         .help = "Which points of the disk a pixel takes. Random start: a row of the noise map from a "
                                 "random place on. Interpolated: from the pixel's own place on, which bands. One "
                                 "dimension: always the same row. Constants: the same points for every pixel, which "
                                 "shows steps instead of noise and reads no noise map.",
                         .choices = noiseNames}};
    Choice<TwoStep> twoStep{*this,
                            {.id = "two-step",
                             .label = "Two-step test",
                             .value = double(TwoStep::Outer),
                             .programConstant = true,
                             .source = "Valient, de Boer, figures 3 and 4",
                             .help = "Leaves out samples whose own disk does not hold the receiver: thin things then "
                                     "throw no shadow on themselves. Outer: of receivers that the light's centre "
                                     "lights, in the outer penumbra. Everywhere: of shadowed ones as well, which lets "
                                     "light in behind what reaches down to them.",
                             .choices = twoStepNames}};
    Flag objectIds{*this,
                   {.id = "object-ids",
                    .label = "Object numbers",
                    .value = 0,
                    .programConstant = true,
                    .source = "Brabec, Seidel 2002; Valient, de Boer, Stochastic sampled PCF",
                    .help = "Things throw no shadow on themselves at all. Takes false shadows off slanting receivers, "
                            "and the true ones as well; draws everything once more."}};
    Choice<Listing> listing{
        *this,
        {.id = "listing",
         .value = double(Listing::Corrected),
         .programConstant = true,
         .source = "Valient, de Boer, eq. 3 and listings",
         .help = "The slips of the printed text, one by one or all: noise that is not moved to the disk's centre; an "
                 "early-out that compares the wrong way; a sum that starts with the hard shadow; a distance that is "
                 "the same everywhere (published pre-processing).",
         .choices = listingNames}};
    Choice<Distance> distance{*this,
                              {.id = "distance",
                               .label = "Stored distance",
                               .value = double(Distance::Fragment),
                               .source = "Valient, de Boer eq. 4 (of vertices, interpolated)",
                               .help = "To the light's centre, of each fragment or interpolated from vertices, which "
                                       "errs on large triangles; or along the light's axis. A directional light has "
                                       "only its axis.",
                               .choices = distanceNames}};
    Real attenuationStart{*this,
                          {.id = "attenuation-start",
                           .label = "Attenuation start",
                           .value = 0,
                           .min = 0,
                           .max = 1e4,
                           .unit = Unit::Metres,
                           .scale = Scale::Logarithmic,
                           .smallest = 1e-3,
                           .source = "Valient, de Boer eq. 4",
                           .help = "Distance that is stored as 0; what is nearer is taken to be there. 0: fitted to "
                                   "the scene.",
                           .active = radial,
                           .inactiveReason = "only the distance to the light's centre has it"}};
    Real attenuationEnd{*this,
                        {.id = "attenuation-end",
                         .label = "Attenuation end",
                         .value = 0,
                         .min = 0,
                         .max = 1e4,
                         .unit = Unit::Metres,
                         .scale = Scale::Logarithmic,
                         .smallest = 1e-3,
                         .source = "Valient, de Boer eq. 4",
                         .help = "Distance that is stored as 1; what is farther casts no shadow. 0: fitted to the "
                                 "scene.",
                         .active = radial,
                         .inactiveReason = "only the distance to the light's centre has it"}};
    LightScale lightScale{*this, "Valient, de Boer eq. 1 (r is the light's own)"};
    Flag accumulate{*this,
                    {.id = "accumulate",
                     .value = 0,
                     .source = "ours",
                     .help = "While nothing moves, each frame takes other samples, and the picture is the mean of "
                             "all. Noise goes away; what else is wrong stays."}};
    Flag filter{*this,
                {.id = "neighbourhood-filter",
                 .value = 0,
                 .source = "Scherzer 2009, 3.3 (the filter of temporal)",
                 .help = "Averages the samples of neighbours that lie on the same surface, over half the penumbra's "
                         "width, where they are few. Smooth penumbrae for a few more reads; small ones get wider."}};
    ShadowMapParameters map{*this, {.faces = Faces::Back}};
    BiasParameters bias{*this, {.slope = 0.05, .normalOffset = 0.5}};
};

// n points of the square [−1, 1]² by best candidate (Mitchell 1991) on the torus, so that none crowd at its edges; of a
// round light mapped to the disk, which keeps areas. The same points for the same set.
std::array<vec2, pointsInSet> lightPoints(bool round, uint32_t set) {
    constexpr int candidates = 512;
    std::array<vec2, pointsInSet> square;
    std::mt19937 random(2006 + set);
    const auto uniform = [&] { return static_cast<float>(random() >> 8) / 8388608.0f - 1; };
    for (size_t i = 0; i < square.size(); ++i) {
        float farthest = -1;
        for (int k = 0; k < candidates; ++k) {
            const vec2 p{uniform(), uniform()};
            float nearest = 8;
            for (size_t j = 0; j < i; ++j) {
                const vec2 apart = glm::abs(p - square[j]), d = glm::min(apart, 2.0f - apart);
                nearest = std::min(nearest, glm::dot(d, d));
            }
            if (nearest > farthest) farthest = nearest, square[i] = p;
        }
    }
    if (round)
        for (vec2& p : square) {
            const PlanePoint onDisk = concentricDisk({p.x, p.y});
            p = {onDisk.x, onDisk.y};
        }
    return square;
}

constexpr Channel noiseChannels[] = {
    {"x", "", "point of the light's shape, [−1, 1] stored as [0, 1]", Unit::None, 0, 1},
    {"y", "", "point of the light's shape, [−1, 1] stored as [0, 1]", Unit::None, 0, 1},
    {"start-x", "", "where a pixel starts, as a share of a row", Unit::None, 0, 1},
    {"start-y", "", "which row a pixel starts in, as a share of all", Unit::None, 0, 1}};

// Each row is a Poisson-disk set; blue and alpha are independent random numbers.
std::shared_ptr<const std::vector<float>> makeNoiseMap(bool round) {
    auto texels = std::make_shared<std::vector<float>>();
    std::mt19937 random(12345);
    const auto uniform = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
    for (uint32_t row = 0; row < noiseRows; ++row)
        for (const vec2 p : lightPoints(round, row)) {
            const float start = uniform();
            texels->insert(texels->end(), {0.5f * p.x + 0.5f, 0.5f * p.y + 0.5f, start, uniform()});
        }
    return texels;
}

Image supplyNoise(Flow& flow, Scope scope, bool round) {
    static const std::shared_ptr<const std::vector<float>> maps[] = {makeNoiseMap(false), makeNoiseMap(true)};
    return flow.pass(scope, {.stage = Stage::Prefilter,
                             .name = "noise",
                             .work = Supply{maps[round]},
                             .writes = {{"noise", Format::RGBA32F, {pointsInSet, noiseRows}, noiseChannels}}});
}

constexpr Channel edgeChannels[] = {
    {"depth", "z", "of the shadow map", Unit::DepthRange, 0, 1},
    {"occluder", "", "on a hard boundary the least depth of the neighbourhood; elsewhere 1", Unit::DepthRange, 0, 1},
    {"edge", "", "1 on a hard boundary", Unit::None, 0, 1}};
constexpr Channel preparedChannels[] = {
    {"depth", "R", "of the shadow map", Unit::DepthRange, 0, 1},
    {"occluder", "G", "depth of the nearest occluder; 1: none within the largest radius", Unit::DepthRange, 0, 1},
    {"inverse-distance", "B",
     "to the nearest hard boundary: largest radius + 1 on it, one less a texel, 0 beyond the largest radius",
     Unit::Texels}};
constexpr Channel rowChannels[] = {
    {"occluder", "", "least depth along the row", Unit::DepthRange, 0, 1},
    {"distance", "", "to the nearest hard boundary of the row; 1000000: none within the largest radius", Unit::Texels}};
constexpr Channel floodChannels[] = {{"x", "Δx", "offset to the nearest hard boundary; 1024: none yet", Unit::Texels},
                                     {"y", "Δy", "offset to the nearest hard boundary; 1024: none yet", Unit::Texels}};
// A history as renderer/techniques/temporal.cpp keeps it, so that its filter can show it.
constexpr Channel sampleChannels[] = {
    {"rho", "ρ", "samples of the disk that are hidden from the light's centre", Unit::Samples},
    {"n", "n", "samples of the disk; the most there may be where none were needed", Unit::Samples},
    {"depth", "d", "distance along the view axis; 0: no surface", Unit::Metres},
    {"blocker", "d_b", "depth of the occluder that the disk was sized for, along the light's axis; 0: not filtered",
     Unit::Metres}};
constexpr std::string_view regionNames[] = {"no surface", "lit", "outer penumbra", "inner penumbra",
                                            "umbra or turned away"};
constexpr Channel regionChannels[] = {{"region", "",
                                       "which of the paper's regions a pixel is in; only penumbrae are filtered",
                                       Unit::None, 0, 4, regionNames},
                                      {"samples", "N", "samples of the disk; 0: not filtered", Unit::Samples}};

struct JumpConstants {
    ivec4 jump; // x = how far the neighbours are [texels]
};

struct DiskConstants {
    ResolveConstants resolve;
    vec4 shift_turn;             // as the shader has it
    vec4 table[pointsInSet / 2]; // the constants, two to a vector
};

struct FilterConstants {
    ResolveConstants resolve;
    vec4 forwardScale;     // xyz the view axis, w = pixels² per m² at eye depth 1
    vec4 taps[filterTaps]; // of the unit disk, two to a vector
};

class FractionalDisk final : public Technique {
public:
    FractionalDisk() {
        // All of the penumbra's noise is averaged, until the samples themselves are many.
        const auto set = [&](std::string_view id, double value) { filter_->parameters().at(id).set(value); };
        set("s-min", 0.01), set("s-max", 0.03), set("few-samples", 0), set("taps", 16), set("thin-out", 0);
    }

    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        const bool prepared = prepares(parameters_), searches = parameters_.preparation == Preparation::NoneCorrected;
        const int texel = parameters_.objectIds ? 2 : 1; // of the map
        const int sample = texel + (parameters_.noise == Noise::Constants ? 0 : 1);
        const int most = sample * parameters_.maxSamples;
        const int start = texel - 1 + (parameters_.noise == Noise::RandomStart ? 1 : 0);
        if (searches) return TextureReads{1 + start + most, 1 + start + 2 * most};
        return TextureReads{1 + start + (prepared ? 0 : sample), 1 + start + most};
    }

    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const ShadowMap map = drawShadowMap(flow, scope, inputs, describeMap(inputs));
        if (!parameters_.accumulate && !parameters_.filter)
            return sample(flow, scope, inputs, map, {}, {"shadow", Format::R32F, {}, shadowChannels()});
        // Samples and their number, to be shown by a pass of its own.
        const Extent extent{inputs.view.size.x, inputs.view.size.y};
        const ImageSpec samples{"samples", Format::RGBA32F, extent, sampleChannels};
        std::optional<PastImage> past;
        if (parameters_.accumulate) past = flow.past(scope, samples, historyKey(inputs));
        if (past && past->age() >= mostFrames) flow.finish(*past);
        return show(flow, scope, inputs, map.view, sample(flow, scope, inputs, map, past, samples));
    }

private:
    // Writes ψ, or the samples and their number where `writes` has room for them.
    Image sample(Flow& flow, Scope scope, const Inputs& inputs, const ShadowMap& map,
                 const std::optional<PastImage>& past, const ImageSpec& writes) const {
        const bool keeps = writes.format == Format::RGBA32F;
        const bool prepared = prepares(parameters_), round = inputs.light.shape != LightShape::Rectangle;
        const glm::ivec2 size = keeps ? inputs.view.size : inputs.pictureSize();
        // Each frame starts elsewhere in the noise map, with its points turned or shifted.
        const auto frame = static_cast<uint32_t>(past ? past->age() : 0);
        const vec2 offset = glm::fract(r2Point(frame) + haltonPoint(inputs.seed));
        const float angle = float(2 * M_PI) * r2Point(frame).x;
        const vec2 turn = round ? vec2(std::cos(angle), std::sin(angle)) : r2Point(frame);
        DiskConstants constants{resolveConstants(inputs, map.view, keeps),
                                vec4(glm::floor(offset * vec2(pointsInSet, noiseRows)), turn),
                                {}};
        Resolver resolver{.shader = "techniques/fractional_disk.glsl",
                          .table = pointsInSet / 2,
                          .writes = writes.name,
                          .channels = writes.channels,
                          .defines = {{"PREPARED", prepared ? 1 : 0}},
                          .format = writes.format,
                          .withMargin = keeps,
                          .also = {{"regions", Format::RG16F, {size.x, size.y}, regionChannels}}};
        if (keeps) resolver.defines.push_back({past ? "ACCUMULATES" : "KEEPS_SAMPLES"});
        if (map.view.range.w != 0) resolver.defines.push_back({"RADIAL_METRIC"});
        PassReads reads = {{"shadowMap", map.depth}};
        if (past) reads.push_back({"history", *past});
        if (map.objects) {
            reads.push_back({"casting", *map.objects});
            reads.push_back({"receiving", drawObjects(flow, scope, inputs)});
        }
        if (prepared) reads.push_back({"prepared", prepare(flow, scope, map)});
        if (parameters_.noise == Noise::Constants) {
            static const std::array<vec2, pointsInSet> sets[] = {lightPoints(false, 0), lightPoints(true, 0)};
            const auto& points = sets[round];
            for (size_t i = 0; i < points.size(); i += 2)
                constants.table[i / 2] = vec4(points[i].x, points[i].y, points[i + 1].x, points[i + 1].y);
        } else {
            reads.push_back({"noise", supplyNoise(flow, scope, round)});
        }
        resolver.constants = constants;
        return resolve(flow, scope, inputs, resolver, reads, parameters_)[0];
    }

    // By the filter of the technique that has one for its histories, or, with it off, the mean of the samples alone.
    Image show(Flow& flow, Scope scope, const Inputs& inputs, const LightViewBlock& light, Image samples) const {
        const View& view = inputs.view;
        FilterConstants constants{
            resolveConstants(inputs, light),
            vec4(glm::normalize(glm::cross(view.rayDy, view.rayDx)), 1 / glm::dot(view.rayDx, view.rayDx)),
            {}};
        constants.resolve.lightView.light.x *= parameters_.lightScale;
        constants.resolve.lightView.light.y *= parameters_.lightScale;
        ParameterSet& filter = filter_->parameters();
        Parameter& neighbourhood = filter.at("neighbourhood");
        neighbourhood.setText(parameters_.filter ? "poisson" : "off");
        int i = 0;
        for (const vec2 p : poissonDisk(static_cast<int>(filter.at("taps").value()))) {
            vec4& pair = constants.taps[i / 2];
            (i % 2 ? pair.z : pair.x) = p.x;
            (i % 2 ? pair.w : pair.y) = p.y;
            ++i;
        }
        return resolve(flow, scope, inputs,
                       {.shader = "techniques/temporal_filter.glsl",
                        .constants = constants,
                        .table = filterTaps,
                        .pass = "filter"},
                       {{"shadowBuffer", samples}}, filter);
    }

    // Of all that the samples depend on.
    uint64_t historyKey(const Inputs& inputs) const {
        Hash hash;
        const ViewBlock view = viewBlock(inputs.view);
        hash.addBytes(&view, sizeof(view));
        static_assert(sizeof(AreaLight) == 13 * sizeof(float));
        hash.addBytes(&inputs.light, sizeof(inputs.light));
        hash.add(inputs.poseVersion);
        hash.add(inputs.seed);
        for (const Parameter* parameter : parameters_.all())
            if (parameter != &parameters_.filter) hash.add(parameter->bits()); // nothing filtered is kept
        return hash.value();
    }

    ShadowMapDescription describeMap(const Inputs& inputs) const {
        static constexpr Metric metrics[] = {Metric::Radial, Metric::RadialOfVertices, Metric::Axial};
        ShadowMapDescription description = parameters_.map.describe();
        description.objects = parameters_.objectIds;
        if (inputs.light.shape == LightShape::Directional) return description;
        description.metric = metrics[static_cast<int>(Distance(parameters_.distance))];
        description.range = {float(parameters_.attenuationStart), float(parameters_.attenuationEnd)};
        return description;
    }

    // Which thing each pixel of the geometry buffer shows.
    static Image drawObjects(Flow& flow, Scope scope, const Inputs& inputs) {
        static constexpr Channel zChannels[] = {{"z", "", "the rasteriser's own depth; 1: near plane, 0: far plane"}};
        const Extent extent{inputs.view.size.x, inputs.view.size.y};
        return flow.pass(scope, {.stage = Stage::Scene,
                                 .name = "objects",
                                 .work = Draw{.shader = "objects.glsl",
                                              .geometry = inputs.geometry,
                                              .poseVersion = inputs.poseVersion,
                                              .faces = Faces::Shown,
                                              .reversedDepth = true},
                                 .writes = {{"objects", Format::R32F, extent, objectChannels},
                                            {"objects-z", Format::Depth32F, extent, zChannels}},
                                 .constants = viewBlock(inputs.view)})[0];
    }

    // The map with what its texels know of their surroundings.
    Image prepare(Flow& flow, Scope scope, const ShadowMap& map) const {
        const Extent extent = flow.spec(map.depth).extent;
        const auto pass = [&](std::string_view name, std::string_view shader, Defines defines, const PassReads& reads,
                              decltype(PassSpec::writes) writes, const Constants& constants = {}) {
            return flow.pass(scope, {.stage = Stage::Prefilter,
                                     .name = name,
                                     .work = Compute{shader, defines},
                                     .reads = reads,
                                     .writes = writes,
                                     .constants = constants,
                                     .parameters = &parameters_});
        };
        const ImageSpec prepared{"prepared", Format::RGBA32F, extent, preparedChannels};
        const ImageSpec flood{"flood", Format::RG16F, extent, floodChannels}; // whole numbers below 2048 are exact
        const bool floods = parameters_.preparation == Preparation::Flood;
        decltype(PassSpec::writes) found{{"edges", Format::RGBA32F, extent, edgeChannels}};
        Defines finds;
        if (floods) {
            found.push_back({"seeds", flood.format, extent, floodChannels});
            finds.push_back({"SEEDS"});
        }
        const Flow::Outputs first =
            pass("edges", "techniques/fractional_disk_edges.glsl", finds, {{"shadowMap", map.depth}}, found);
        const Image edges = first[0];
        const int radius = parameters_.maxRadius;
        if (parameters_.preparation == Preparation::Published) {
            Image image = edges;
            flow.repeat(radius, [&](int) {
                image = pass("spread", "techniques/fractional_disk_spread.glsl", {}, {{"before", image}}, {prepared});
            });
            return image;
        }
        if (parameters_.preparation == Preparation::Separable) {
            static constexpr std::string_view shader = "techniques/fractional_disk_separable.glsl";
            const Image rows =
                pass("rows", shader, {{"ROWS"}}, {{"edges", edges}}, {{"rows", Format::RG32F, extent, rowChannels}});
            return pass("columns", shader, {}, {{"edges", edges}, {"rows", rows}}, {prepared});
        }
        static constexpr std::string_view shader = "techniques/fractional_disk_flood.glsl";
        const int rounds = std::bit_width(static_cast<unsigned>(radius - 1)); // the jumps reach 2^rounds texels
        Image image = first[1];
        flow.repeat(std::max(rounds, 1), [&](int i) {
            const JumpConstants constants{ivec4(1 << std::max(rounds - 1 - i, 0), 0, 0, 0)};
            image = pass("flood", shader, {}, {{"before", image}}, {flood}, constants);
        });
        return pass("flood-last", shader, {{"LAST"}}, {{"edges", edges}, {"before", image}}, {prepared},
                    JumpConstants{ivec4(1, 0, 0, 0)});
    }

    Parameters parameters_;
    std::unique_ptr<Technique> filter_ = makeTechnique(findCard("temporal"));
};

} // namespace

extern const Card fractionalDiskCard;
const Card fractionalDiskCard{
    .id = "fractional-disk",
    .title = "Fractional-disk soft shadows",
    .authors = "Valient, de Boer",
    .year = 2006,
    .venue = "ShaderX4",
    .idea = "What share of the light a point sees is what share of a disk around it the light's centre sees. The map's "
            "texels are told of the nearest occluder and of the distance to the nearest edge beforehand, so that only "
            "pixels of a penumbra are filtered, over a disk as wide as the penumbra.",
    .assumes = "Closed objects, whose back faces cast. Light, occluder and receiver are parallel. One map, from the "
               "light's centre.",
    .fails = "Where occluders overlap, the map holds the nearest one only: neighbours take disks of quite different "
             "sizes, and penumbrae break off along a line (the paper's figure 8; scene two-depths). Disks are cut off "
             "at the largest radius. Open sheets that face the light cast nothing. Light leaks under thick objects, "
             "whose back faces lie far below their edges, and along thin ones. Noise.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-4,
    .make = [] { return std::unique_ptr<Technique>(new FractionalDisk); },
};

} // namespace penumbra
