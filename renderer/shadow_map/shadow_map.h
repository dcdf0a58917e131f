// SPDX-License-Identifier: MIT
// Depth as seen from a point of the light: how a map is described, fitted to the scene, drawn and looked up.
#pragma once

#include "renderer/core/technique.h"
#include "renderer/inputs.h"
#include "renderer/shared.h"

namespace penumbra {

// A point on the light, in light space: lightPoint() of scene/light.h. Zero is the light's centre.
using LightSample = glm::vec2;
inline constexpr LightSample lightCentre{0, 0};

// What depth means: along the light's axis, or from the light's point (not for directional lights), of each fragment or
// of the vertices and interpolated.
enum class Metric { Axial, Radial, RadialOfVertices };

// What the map's window holds: all that receives shadows, or of that what the view shows.
enum class Fit { Scene, View };

// Everything that makes one shadow map another; equal descriptions under one light are one map.
struct ShadowMapDescription {
    int size = 1024; // texels along a side
    Faces faces = Faces::Casting;
    Fit fit = Fit::Scene;
    LightSample sample = lightCentre;
    Metric metric = Metric::Axial;
    glm::vec2 range{0, 0};            // of radial depth [m], from and to; what is 0 is fitted to the scene
    Format format = Format::Depth32F; // or R32F, for depths that need a sign
    int samples = 1;                  // a texel; the driver's counts
    int layer = 0;                    // 0: the nearest surfaces, n: those behind the n-th; at most mostLayers − 1
    // Moves the grid of texels by at most half a texel: without it the maps of a light have much the same grid on the
    // reference plane, and the mean of many keeps the rounding of each.
    glm::vec2 shift{0, 0};
    // One of many whose tests are averaged, texel by texel: each side of the window is only as long as it must be, and
    // what shades nothing is not drawn. Filtered maps need square texels and what lies behind their blockers.
    bool averaged = false;
    int border = 1; // texels along the edge that stay empty: a lookup outside is clamped to them and finds no caster
    bool objects = false;    // an image of the numbers of the things that cast, too
    bool signMovers = false; // depth is negative where a caster's pose differs from the last frame's; needs R32F
};
inline constexpr int mostLayers = 8;

// The shift of the i-th of many maps: even over a texel and unrelated to Halton's points.
glm::vec2 gridShift(uint32_t i);

// What every technique that reads a shadow map lets its user turn.
struct ShadowMapParameters : ParameterGroup {
    struct Options {
        Faces faces = Faces::Casting; // at first
        Fit fit = Fit::Scene;
        double size = 1024, largest = 16384; // texels along a side
    };
    explicit ShadowMapParameters(ParameterSet& s) : ShadowMapParameters(s, Options{}) {}
    ShadowMapParameters(ParameterSet& s, const Options& options)
        : ParameterGroup(s, "Shadow map")
        , size{set,
               {.id = "map-size",
                .label = "Map size",
                .value = options.size,
                .min = 16,
                .max = options.largest,
                .unit = Unit::Texels,
                .scale = Scale::Logarithmic,
                .source = "Williams 1978",
                .help = "Texels along a side of the shadow map. Finer edges and less bias for more memory and time."}}
        , faces{set,
                {.id = "faces",
                 .value = double(options.faces),
                 .source = "Reeves 1987; Wang and Molnar 1994 (back faces)",
                 .help =
                     "Which faces cast. Casting: those that the scene shows, as in the truth: fronts, and backs where "
                     "a material has two sides. Back faces need no bias on closed objects, but leak light at thin "
                     "ones.",
                 .choices = facesNames}}
        , fit{set,
              {.id = "fit",
               .label = "Fit to",
               .value = double(options.fit),
               .source = "Brabec, Annen and Seidel 2002",
               .help = "What the map's texels are spread over. Those of the scene stay where they are while the camera "
                       "moves; those of the view are smaller where the view shows a part of the scene, but crawl.",
               .choices = fitNames}} {}
    Integer size;
    Choice<Faces> faces;
    Choice<Fit> fit;
    End end{set};

    ShadowMapDescription describe(LightSample sample = lightCentre) const { return {size, faces, fit, sample}; }

    static constexpr std::string_view facesNames[] = {"casting", "both", "front", "back"};
    static constexpr std::string_view fitNames[] = {"scene", "view"};
};

// How a comparison is kept from finding a surface in its own shadow (acne) without letting light under things.
struct BiasParameters : ParameterGroup {
    struct Defaults {
        double slope, normalOffset;
        double (*slopeFrom)(const ParameterSet&) = nullptr; // where the slope bias hangs on other parameters
    };
    BiasParameters(ParameterSet& s, Defaults defaults)
        : ParameterGroup(s, "Bias")
        , constant{set,
                   {.id = "depth-bias",
                    .label = "Depth bias",
                    .value = 2e-5,
                    .min = 0,
                    .max = 0.1,
                    .unit = Unit::DepthRange,
                    .scale = Scale::Logarithmic,
                    .smallest = 1e-7,
                    .source = "Williams 1978",
                    .help = "Added to every stored depth, as a share of the map's depth range. Hides rounding; more of "
                            "it detaches shadows from what casts them."}}
        , slope{set,
                {.id = "slope-bias",
                 .label = "Slope bias",
                 .value = defaults.slope,
                 .min = 0,
                 .max = 16,
                 .unit = Unit::Texels,
                 .source = "King 2004; OpenGL polygon offset",
                 .help = "Depth by which the receiver's plane rises over this many texels. Half a texel removes acne "
                         "from planes that are compared at their own depth; surfaces that graze the light then leak.",
                 .defaultFrom = defaults.slopeFrom}}
        , normalOffset{set,
                       {.id = "normal-offset",
                        .label = "Normal offset",
                        .value = defaults.normalOffset,
                        .min = 0,
                        .max = 16,
                        .unit = Unit::Texels,
                        .source = "Holbert 2011",
                        .help = "Moves the looked-up point off its surface by this many texels times the sine of the "
                                "angle to the light. Never diverges, but makes thin shadows thinner."}} {}
    Real constant, slope, normalOffset;
    End end{set};
};

// For techniques that compare a receiver with more than its own texel.
struct ReceiverPlane : Flag {
    explicit ReceiverPlane(ParameterSet& s)
        : Flag(s,
               {.id = "receiver-plane",
                .label = "Receiver plane",
                .value = 1,
                .source = "Isidoro 2006; here the plane itself instead of its slope",
                .help = "Compares each texel with the depth of the receiver's plane there instead of one depth. Wide "
                        "kernels and penumbrae then need no more bias than narrow ones."}) {}
};

// For techniques that take the width of penumbrae from the light's size.
struct LightScale : Real {
    explicit LightScale(ParameterSet& s, std::string_view source = {})
        : Real(s, {.id = "light-scale",
                   .label = "Light scale",
                   .value = 1,
                   .min = 0,
                   .max = 4,
                   .source = source,
                   .help = "Widens or narrows the penumbrae beyond what the light's size gives. 1 is the light itself; "
                           "anything else departs from the truth."}) {}
};

// The projection of a map. The depth range is fitted to casters and receivers as seen from the whole light, and is the
// same for every sample; the window to what is seen from the sample. Without a view it is fitted to the scene.
LightViewBlock lightView(const AreaLight& light, std::span<const Occluder> occluders,
                         const ShadowMapDescription& description, const View* view = nullptr);
inline LightViewBlock lightView(const Inputs& inputs, const ShadowMapDescription& description) {
    return lightView(inputs.light, inputs.occluders, description, &inputs.view);
}

// Draws a map: an image "shadow-map" ("shadow-map-2" for the second layer ..., "shadow-map-samples") of linear depth in
// [0, 1], 1 where nothing casts. Layers are peeled one behind the other, each with those before it.
struct ShadowMap {
    Image depth;
    LightViewBlock view;
    std::optional<Image> objects;
};
inline constexpr Channel objectChannels[] = {{"object", "", "number of the thing that is seen, from 1"}};
ShadowMap drawShadowMap(Flow& flow, Scope scope, const Inputs& inputs, const ShadowMapDescription& description);

// What every shader that includes shaders/resolve.glsl is told, and the front of its constants.
Defines resolveDefines(const AreaLight& light);
struct ResolveConstants {
    ViewBlock view;
    LightViewBlock lightView;
};
ViewBlock viewBlock(const View& view);
// For a pass that writes an image of the picture's size or, `withMargin`, of the geometry buffer's.
ResolveConstants resolveConstants(const Inputs& inputs, const LightViewBlock& light, bool withMargin = false);

// A shader that includes shaders/resolve.glsl, and its constants: ResolveConstants, then `table` vectors of its own.
struct Resolver {
    std::string_view shader;
    Constants constants;
    int table = 0;
    // What it writes: ψ as "shadow", of the picture's size, unless stated otherwise.
    std::string_view pass = "resolve", writes = "shadow";
    std::span<const Channel> channels = shadowChannels();
    Defines defines = {};
    Format format = Format::R32F;
    bool withMargin = false;             // as large as the geometry buffer, not as the picture
    std::optional<Extent> extent = {};   // or of a size of its own
    FixedVector<ImageSpec, 3> also = {}; // further images
    FixedVector<Image, 2> onto = {};     // instead of what it writes: images that it changes
    FixedVector<TileSet, 2> marks = {};
    std::optional<TileSet> over = {};
};
using PassReads = decltype(PassSpec::reads);
// Appends its pass: reads depth, normal and `reads`.
Flow::Outputs resolve(Flow& flow, Scope scope, const Inputs& inputs, const Resolver& resolver, const PassReads& reads,
                      const ParameterSet& parameters);

} // namespace penumbra
