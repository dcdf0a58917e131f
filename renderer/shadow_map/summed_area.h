// SPDX-License-Identifier: MIT
// Moments of the depths in any box of a shadow map, from a summed-area table in whole numbers: what techniques that
// take the width of a penumbra from what blocks (percentage-closer soft shadows) ask moments with.
#pragma once

#include "renderer/shadow_map/moment_map.h"

namespace penumbra {

#include "shaders/shared/summed_area.glsl.h"
static_assert(sizeof(SummedAreaBlock) == 96 && sizeof(SummedAreaLookupBlock) == 144);

// Of techniques that look at windows of such a table; see shaders/soft_moments.glsl.
struct SoftMomentParameters : ParameterGroup {
    explicit SoftMomentParameters(ParameterSet& s)
        : ParameterGroup(s, "Windows")
        , cells{set,
                {.id = "cells",
                 .symbol = "n",
                 .value = 4,
                 .min = 1,
                 .max = 8,
                 .source = "Yang et al. 2010 (subdivided kernels)",
                 .help = "Search and filter look at n by n cells of a window. More of them leak less light, and leave "
                         "contacts and slopes less blurred; each is 8 texture reads and more."}}
        , widest{set,
                 {.id = "widest-window",
                  .label = "Widest window",
                  .value = 512,
                  .min = 32,
                  .max = 2048,
                  .unit = Unit::Texels,
                  .scale = Scale::Logarithmic,
                  .source = "Peters et al. 2017 (precision by kernel size)",
                  .help = "Wider windows are cut to this. A sum over the largest cell must fit 32 bits: the smaller "
                          "it is the more bits each texel has, and the less bias it needs."}}
        , lightScale(set)
        , planeBias{set,
                    {.id = "plane-bias",
                     .label = "Plane bias",
                     .value = 0,
                     .min = 0,
                     .max = 2,
                     .help = "Moves the receiver towards the light by so many standard deviations of its plane's depth "
                             "within a cell. Keeps lit slopes lit; what lies close above them casts less."}} {}
    Integer cells, widest;
    LightScale lightScale;
    Real planeBias;
    End end{set};

    // Steps between the ends of a stored moment's range, so that no box within a cell sums up to 2³².
    double levels() const { return levelsOf(set); }
    static double levelsOf(const ParameterSet& set);

    TextureReads reads() const {
        const int window = 8 * cells * (cells + 1);
        return {window, 2 * window};
    }
};

// The first two or four powers of depths in [−1, 1]; from one map texel 8 or 16 bytes in either of two tables, and 1/16
// of that for runs.
struct SummedArea {
    Image sums, depths;
    LightViewBlock view;
};
SummedArea drawSummedArea(Flow& flow, Scope scope, const Inputs& inputs, int count, const ShadowMapDescription& map,
                          const SoftMomentParameters& windows);

// The pass from such a table to ψ: a shader that includes soft_moments.glsl. Where a pixel is probed another pass tells
// of its filter's window, for windowPlots().
Image resolveSoft(Flow& flow, Scope scope, const Inputs& inputs, std::string_view shader, int count,
                  const SummedArea& table, const SoftMomentParameters& windows, const ParameterSet& parameters,
                  double alpha = 0);
std::span<const ProbePlot> windowPlots();

} // namespace penumbra
