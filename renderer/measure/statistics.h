// SPDX-License-Identifier: MIT
// Statistics of measured times. Nothing is assumed of their distribution, which has a long tail: medians, and intervals
// from order statistics.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace penumbra {

// The value that at least `share` in (0, 1] of the values do not exceed (nearest rank). Of no values: 0.
double percentile(std::span<const double> values, double share);
// The middle value, or the mean of the middle two. Of no values: 0.
double median(std::span<const double> values);

// Where the median of what was sampled lies, with the probability `coverage` over repetitions of the experiment.
struct Interval {
    double low = 0, high = 0;
    double coverage = 0;
};

// The narrowest pair of order statistics x(k), x(n + 1 - k) that holds the median with a probability of at least
// `confidence`: the number of values below the median is binomial, B(n, 1/2), so the coverage is 1 - 2 P(B < k). Fewer
// than 6 values cannot hold it with 0.95; then it is their range, with the coverage that this has.
Interval medianInterval(std::span<const double> values, double confidence = 0.95);

struct TimeSummary {
    double median = 0, p95 = 0, min = 0;
    Interval interval; // of the median
    size_t count = 0;
};
TimeSummary summarise(std::span<const double> values);

// How many times as long one thing takes as another, from rounds in which both were timed one after the other: the
// median of the ratios a(i) / b(i), so that a drift of the machine, which hits both, cancels.
struct Ratio {
    double median = 1;
    Interval interval;
    // Whether the difference is more than noise: 1 lies outside of a 95 percent interval.
    bool differs() const { return interval.coverage >= 0.95 && (interval.low > 1 || interval.high < 1); }
};
// Two spans of one length. Of no rounds: 1, which differs from nothing.
Ratio medianRatio(std::span<const double> a, std::span<const double> b);

// Which of the points (cost, error) are on the trade-off front: no other point is at least as cheap and as close, and
// better in one of the two. A NaN, which stands for what is not known, is never on it.
struct TradeOff {
    double cost, error;
};
std::vector<bool> tradeOffFront(std::span<const TradeOff> points);

} // namespace penumbra
