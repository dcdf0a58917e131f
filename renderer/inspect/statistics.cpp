// SPDX-License-Identifier: MIT
#include "renderer/inspect/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace penumbra {
namespace {

constexpr double lowQuantile = 0.01, highQuantile = 0.99;
constexpr double mostFloat = std::numeric_limits<float>::max();

// The inverse of keyOf in shaders/inspect/measure.glsl.
float valueOfKey(uint32_t key) { return std::bit_cast<float>(key & 0x80000000u ? key & 0x7fffffffu : ~key); }

float toFloat(double value) { return static_cast<float>(std::clamp(value, -mostFloat, mostFloat)); }

} // namespace

Statistics::Statistics() {
    std::fill(std::begin(measured.first), std::end(measured.first), ~0u);
    std::fill(std::begin(measured.least), std::end(measured.least), ~0u);
}

Statistics::Statistics(int channelsLookedAt, ValueRange binned, glm::ivec2 imageSize) : Statistics() {
    channels = channelsLookedAt;
    domain = binned;
    size = imageSize;
}

void Statistics::add(const MeasuredBlock& more) {
    const auto each = [](auto& mine, const auto& theirs, auto&& operation) {
        std::transform(std::begin(mine), std::end(mine), std::begin(theirs), std::begin(mine), operation);
    };
    const auto least = [](uint a, uint b) { return std::min(a, b); };
    const auto most = [](uint a, uint b) { return std::max(a, b); };
    measured.looked += more.looked;
    measured.elsewhere += more.elsewhere;
    each(measured.count, more.count, std::plus());
    each(measured.first, more.first, least);
    each(measured.least, more.least, least);
    each(measured.most, more.most, most);
    each(measured.below, more.below, std::plus());
    each(measured.above, more.above, std::plus());
    each(measured.bins, more.bins, std::plus());
}

std::optional<glm::ivec2> Statistics::first(Mark mark) const {
    if (count(mark) == 0) return std::nullopt;
    const int index = static_cast<int>(measured.first[static_cast<size_t>(mark)]);
    return glm::ivec2(index % size.x, index / size.x);
}

std::optional<ValueRange> Statistics::extremes() const {
    const uint32_t least = *std::min_element(measured.least, measured.least + channels);
    const uint32_t most = *std::max_element(measured.most, measured.most + channels);
    if (least > most) return std::nullopt;
    return ValueRange{valueOfKey(least), valueOfKey(most)};
}

ValueRange nonEmpty(ValueRange range) {
    if (range.min < range.max) return range;
    const double around = range.min == 0 ? 1.0 : std::abs(range.min) / 2.0;
    const ValueRange wider{toFloat(range.min - around), toFloat(range.max + around)};
    return wider.min < wider.max ? wider : ValueRange{range.min - 1, range.max + 1}; // half the least float is 0
}

ValueRange hull(ValueRange a, ValueRange b) { return {std::min(a.min, b.min), std::max(a.max, b.max)}; }

ValueRange widened(ValueRange range, double share) {
    const double margin = share * (double{range.max} - range.min);
    return {toFloat(range.min - margin), toFloat(range.max + margin)};
}

std::optional<ValueRange> quantileRange(std::span<float> values) {
    const auto begin = values.begin();
    const auto end = std::partition(begin, values.end(), [](float value) { return std::isfinite(value); });
    if (begin == end) return std::nullopt;
    const auto quantile = [&](double q) {
        const auto place = begin + static_cast<ptrdiff_t>(std::lround(q * static_cast<double>(end - begin - 1)));
        std::nth_element(begin, place, end);
        return *place;
    };
    const ValueRange range{quantile(lowQuantile), quantile(highQuantile)};
    if (range.min < range.max) return range;
    const auto [least, most] = std::minmax_element(begin, end);
    return ValueRange{*least, *most};
}

} // namespace penumbra
