// SPDX-License-Identifier: MIT
// Light-source sampling (Heckbert and Herf, Simulating soft shadows with graphics hardware, CMU-CS-97-104, 1997; thesis
// 4.1): the mean of N hard shadows, each from another point of the light. With N to infinity it is ψ itself, but for
// the resolution and the bias of the maps.
//
// The points are Sobol's, so that the first n of them are spread evenly, best where n is a power of two. A pixel counts
// the maps that hide the light from it: whole numbers, exact in a float to 2^24, so that the mean of N maps is the same
// however many frames they took. N maps, N texture reads a pixel.
#include "renderer/core/hash.h"
#include "renderer/core/technique.h"
#include "renderer/shadow_map/shadow_map.h"

#include <algorithm>

namespace penumbra {
namespace {

struct Parameters : ParameterSet {
    Integer samples{*this,
                    {.id = "samples",
                     .label = "Samples",
                     .symbol = "N",
                     .value = 64,
                     .min = 1,
                     .max = 4096,
                     .unit = Unit::Samples,
                     .scale = Scale::Logarithmic,
                     .source = "Heckbert and Herf 1997",
                     .help = "Points of the light, with a shadow map from each. Penumbrae show N steps; their error "
                             "falls about as N^-3/4."}};
    Integer mapsPerFrame{*this,
                         {.id = "maps-per-frame",
                          .label = "Maps per frame",
                          .value = 4,
                          .min = 1,
                          .max = 64,
                          .unit = Unit::Samples,
                          .scale = Scale::Logarithmic,
                          .help = "In the window the N maps come a few a frame while the view stands still, and the "
                                  "picture is the mean of those so far. Captures and measurements draw all N in each "
                                  "frame."}};
    ShadowMapParameters map{*this, {.fit = Fit::View}};
    BiasParameters bias{*this, {.slope = 0, .normalOffset = 0.25}};
};

struct MeanConstants {
    vec4 maps; // x = how many were counted
};

constexpr Channel countChannels[] = {{"maps", "", "maps so far in which the light's point is hidden", Unit::None}};

class LightSampling final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    std::optional<TextureReads> readsPerPixel() const override {
        return TextureReads{parameters_.samples, parameters_.samples};
    }
    Image build(Flow& flow, Scope scope, const Inputs& inputs) const override {
        const int samples = parameters_.samples;
        const int perFrame = inputs.progressive ? std::min<int>(parameters_.mapsPerFrame, samples) : samples;
        const Extent extent{inputs.pictureSize().x, inputs.pictureSize().y};
        const ImageSpec total{"total", Format::R32F, extent, countChannels};

        std::variant<std::monostate, Image, PastImage> counted;
        int done = 0;
        if (inputs.progressive) {
            const PastImage past = flow.past(scope, total, historyKey(inputs));
            done = static_cast<int>(std::min<int64_t>(int64_t{past.age()} * perFrame, samples));
            if (done > 0) counted = past;
            if (done + perFrame >= samples) flow.finish(past);
        }
        flow.repeat(std::min(perFrame, samples - done), [&](int i) {
            ShadowMapDescription description =
                parameters_.map.describe(lightPoint(inputs.light, samplePoint(inputs.seed, done + i)));
            description.averaged = true;
            description.shift = gridShift(static_cast<uint32_t>(done + i));
            const ShadowMap map = drawShadowMap(flow, scope, inputs, description);
            counted = count(flow, scope, inputs, map, counted);
        });
        done = std::min(done + perFrame, samples);

        PassSpec mean{.stage = Stage::Resolve,
                      .name = "mean",
                      .work = Compute{"techniques/light_sampling_mean.glsl"},
                      .reads = {{"counted", counted}},
                      .writes = {{"shadow", Format::R32F, extent, shadowChannels()}},
                      .constants = MeanConstants{vec4(done, 0, 0, 0)}};
        if (inputs.progressive) {
            std::get<Compute>(mean.work).defines.push_back({"KEEP"});
            mean.writes.push_back(total);
        }
        return flow.pass(scope, mean)[0];
    }

private:
    static glm::vec2 samplePoint(uint32_t seed, int i) { return sobolPoint(static_cast<uint32_t>(i), seed); }

    Image count(Flow& flow, Scope scope, const Inputs& inputs, const ShadowMap& map,
                const std::variant<std::monostate, Image, PastImage>& before) const {
        Resolver resolver{.shader = "techniques/light_sampling.glsl",
                          .constants = resolveConstants(inputs, map.view),
                          .pass = "count",
                          .writes = "count",
                          .channels = countChannels};
        if (std::holds_alternative<std::monostate>(before))
            return resolve(flow, scope, inputs, resolver, {{"shadowMap", map.depth}}, parameters_);
        resolver.defines.push_back({"MORE"});
        return resolve(flow, scope, inputs, resolver, {{"shadowMap", map.depth}, {"before", before}}, parameters_);
    }

    // Of all that a map and its lookups depend on.
    uint64_t historyKey(const Inputs& inputs) const {
        Hash hash;
        const ViewBlock view = viewBlock(inputs.view);
        hash.addBytes(&view, sizeof(view));
        static_assert(sizeof(AreaLight) == 13 * sizeof(float));
        hash.addBytes(&inputs.light, sizeof(inputs.light));
        hash.add(inputs.poseVersion);
        hash.add(inputs.seed);
        for (const Parameter* parameter : parameters_.all()) hash.add(parameter->bits());
        return hash.value();
    }

    Parameters parameters_;
};

} // namespace

extern const Card lightSamplingCard;
const Card lightSamplingCard{
    .id = "light-sampling",
    .title = "Light-source sampling",
    .authors = "Heckbert, Herf",
    .year = 1997,
    .venue = "CMU-CS-97-104",
    .idea = "Draw a shadow map from each of many points of the light, and take the mean of their hard shadows. In the "
            "window the maps come a few a frame and the picture refines; captures and measurements draw all of them in "
            "every frame.",
    .assumes = "Time. Nothing about the scene: with enough maps that are fine enough it is the truth.",
    .fails = "Few samples show as overlapping hard edges. Coarse maps keep the errors of hard shadows: acne, leaks at "
             "contacts, details lost between texels.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-4,
    .make = [] { return std::unique_ptr<Technique>(new LightSampling); },
};

} // namespace penumbra
