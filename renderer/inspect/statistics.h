// SPDX-License-Identifier: MIT
// What was counted of an image, and the ranges that follow from it.
#pragma once

#include "renderer/inspect/look.h"
#include "renderer/shared.h"

#include <cstdint>
#include <optional>
#include <span>

namespace penumbra {

struct Statistics {
    int channels = 1;  // that were looked at: 1 or 3
    ValueRange domain; // of the bins
    glm::ivec2 size{0, 0};
    MeasuredBlock measured = {}; // of measured.looked texels so far

    Statistics(); // of nothing
    Statistics(int channelsLookedAt, ValueRange binned, glm::ivec2 imageSize);
    void add(const MeasuredBlock& more);

    int64_t texels() const { return int64_t{size.x} * size.y; }

    bool complete() const { return measured.looked == texels(); }
    int64_t count(Mark mark) const { return measured.count[static_cast<size_t>(mark)]; }
    // The uppermost texel with the mark, column and row from the upper left.
    std::optional<glm::ivec2> first(Mark mark) const;
    std::span<const uint32_t> bins(int channel) const {
        return std::span(measured.bins).subspan(static_cast<size_t>(channel) * histogramBins, histogramBins);
    }
    // Least and greatest finite value of the channels looked at; none if there is no finite value.
    std::optional<ValueRange> extremes() const;
};

// Never empty: a range of one value is widened by half of it to both sides, or by 1 where it is 0.
ValueRange nonEmpty(ValueRange range);

ValueRange hull(ValueRange a, ValueRange b);

// By a share of its width on either side.
ValueRange widened(ValueRange range, double share);

// From the 1st to the 99th percentile of the finite values; none if there are none. Where the two are the same, as in
// an image of one value with a few others in it, from the least to the greatest. May be of one value. Reorders.
std::optional<ValueRange> quantileRange(std::span<float> values);

} // namespace penumbra
