// SPDX-License-Identifier: MIT
#include "renderer/shadow_map/summed_area.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr MomentFormat stored = MomentFormat::Unorm16Optimised;
constexpr DepthSign depthSign = DepthSign::Signed;

constexpr Channel windowChannels[] = {
    {"z", "z", "depth", Unit::DepthRange},
    {"share", "F", "share of the filter's window in front of that depth", Unit::None, 0, 1},
    {"fragment", "z_f", "depth of the probed pixel's surface, biased", Unit::DepthRange},
    {"psi", "ψ", "what the technique makes of the window at that depth", Unit::None, 0, 1}};

} // namespace

double SoftMomentParameters::levelsOf(const ParameterSet& set) {
    // Whole texels that a box within a cell may hold.
    const double side = std::ceil(set.at("widest-window").value() / set.at("cells").value()) + 1;
    constexpr double words = 4294967295, floats = 16777215; // more than a float tells apart would be lost before
    return std::min(std::floor(words / (side * side)), floats);
}

SummedArea drawSummedArea(Flow& flow, Scope scope, const Inputs& inputs, int count, const ShadowMapDescription& map,
                          const SoftMomentParameters& windows) {
    static constexpr Channel channels[] = {{"b1", "Σb₁", "sum of the depth in steps, up to here, modulo 2³²"},
                                           {"b2", "Σb₂", "sum of the second moment as it is stored"},
                                           {"b3", "Σb₃", "sum of the third"},
                                           {"b4", "Σb₄", "sum of the fourth"}};
    const ShadowMap depths = drawShadowMap(flow, scope, inputs, map);
    const MomentEncoding encoding = encodingOf(count, stored, depthSign);
    const SummedAreaBlock block{.storedFromMoments = glm::mat4(encoding.matrix),
                                .storedOffset = glm::vec4(encoding.offset),
                                .depth_levels = glm::vec4(depthScale(depthSign), windows.levels(), 0)};
    const Format format = count == 2 ? Format::RG32UI : Format::RGBA32UI;
    const int size = map.size, runs = (size + runLength - 1) / runLength;
    const auto image = [&](std::string_view name, int width, int height) {
        return ImageSpec{name, format, {width, height}, std::span(channels).first(static_cast<size_t>(count))};
    };
    // Along one axis: totals of runs, then what starts each run and the sums.
    const auto sumUp = [&](Image source, bool rows, std::string_view totals, std::string_view starts,
                           std::string_view sums) {
        const int width = rows ? runs : size, height = rows ? size : runs;
        Compute work{"summed_area.glsl", {}};
        if (rows) work.defines.push_back({"ROWS"});
        PassSpec pass{.stage = Stage::Prefilter, .name = sums, .work = work, .reads = {{"source", source}}};
        if (rows) pass.constants = block;
        PassSpec ofRuns = pass;
        work.defines.push_back({"TOTALS"});
        ofRuns.name = totals;
        ofRuns.work = work;
        ofRuns.writes = {image(totals, width, height)};
        pass.reads.push_back({"totals", Image(flow.pass(scope, ofRuns))});
        pass.writes = {image(starts, width, height), image(sums, size, size)};
        return flow.pass(scope, pass)[1];
    };
    const Image rows = sumUp(depths.depth, true, "row-totals", "row-starts", "row-sums");
    return {sumUp(rows, false, "column-totals", "column-starts", "summed-area"), depths.depth, depths.view};
}

Image resolveSoft(Flow& flow, Scope scope, const Inputs& inputs, std::string_view shader, int count,
                  const SummedArea& table, const SoftMomentParameters& windows, const ParameterSet& parameters,
                  double alpha) {
    const MomentLookupBlock powers = lookupOfPowers(count, stored, depthSign, alpha);
    const MomentEncoding encoding = encodingOf(count, stored, depthSign);
    const glm::vec4 farthest(encoding.matrix * glm::dvec4(1) + encoding.offset);
    struct Block {
        ResolveConstants resolve;
        SummedAreaLookupBlock lookup;
    } block{resolveConstants(inputs, table.view),
            {.momentsFromSum = powers.momentsFromStored / static_cast<float>(windows.levels()),
             .momentsOffset = powers.momentsOffset,
             .empty = powers.momentsFromStored * farthest + powers.momentsOffset,
             .depth = {depthScale(depthSign), 0.5f * static_cast<float>(windows.widest), 0},
             .range = powers.range}};
    PassReads reads{{"sums", table.sums}};
    if (inputs.inspection.probe) {
        Block probed = block;
        probed.lookup.probed = {*inputs.inspection.probe, 0, 0};
        reads.push_back({"shadowMap", table.depths});
        resolve(flow, scope, inputs,
                {.shader = shader,
                 .constants = probed,
                 .pass = "kernel-probe",
                 .writes = "kernel-depths",
                 .channels = windowChannels,
                 .defines = {{"PROBED_WINDOW"}},
                 .format = Format::RGBA32F,
                 .extent = Extent{probeColumns, 1}},
                reads, parameters);
        reads.pop_back();
    }
    return resolve(flow, scope, inputs, {.shader = shader, .constants = block}, reads, parameters);
}

std::span<const ProbePlot> windowPlots() {
    static constexpr ProbeSeries series[] = {{"kernel-depths.z", "z"},
                                             {"kernel-depths.share", "F(z), the window", ProbeMark::Step},
                                             {"kernel-depths.fragment", "z_f, the fragment", ProbeMark::Upright},
                                             {"kernel-depths.psi", "ψ, as it is set", ProbeMark::Heavy}};
    static constexpr ProbePlot plots[] = {
        {ProbePlot::Kind::Curves, "The window's depths",
         "What share of the window that the filter takes lies in front of a depth, each held against the "
         "receiver's own plane, and what the moments of the window's cells make of it. Heavy: as it is set. Where a "
         "curve crosses the fragment's line is its ψ.",
         series, "Depth z", "ψ"}};
    return plots;
}

} // namespace penumbra
