// SPDX-License-Identifier: MIT
#include "renderer/measure/statistics.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

std::vector<double> sorted(std::span<const double> values) {
    std::vector<double> result(values.begin(), values.end());
    std::sort(result.begin(), result.end());
    return result;
}

// P(B = k) for B(n, 1/2). The logarithm keeps 2^-n from vanishing.
double binomialHalf(size_t n, size_t k) {
    const auto logFactorial = [](size_t m) { return std::lgamma(static_cast<double>(m) + 1); };
    return std::exp(logFactorial(n) - logFactorial(k) - logFactorial(n - k) - static_cast<double>(n) * std::log(2.0));
}

size_t rank(size_t count, double share) { // from 0 on
    const auto atLeast = static_cast<size_t>(std::ceil(share * static_cast<double>(count) - 1e-9));
    return std::clamp<size_t>(atLeast, 1, count) - 1;
}

double middle(const std::vector<double>& ascending) {
    if (ascending.empty()) return 0;
    const size_t half = ascending.size() / 2;
    return ascending.size() % 2 ? ascending[half] : 0.5 * (ascending[half - 1] + ascending[half]);
}

} // namespace

double percentile(std::span<const double> values, double share) {
    return values.empty() ? 0 : sorted(values)[rank(values.size(), share)];
}

double median(std::span<const double> values) { return middle(sorted(values)); }

Interval medianInterval(std::span<const double> values, double confidence) {
    if (values.empty()) return {};
    const std::vector<double> x = sorted(values);
    const size_t n = x.size();
    size_t k = 1;                      // counted from 1, as x(k)
    double below = binomialHalf(n, 0); // P(B < k)
    for (size_t next = 1; 2 * (next + 1) <= n + 1; ++next) {
        const double more = below + binomialHalf(n, next);
        if (1 - 2 * more < confidence) break;
        below = more;
        k = next + 1;
    }
    return {x[k - 1], x[n - k], std::max(1 - 2 * below, 0.0)};
}

TimeSummary summarise(std::span<const double> values) {
    if (values.empty()) return {};
    const std::vector<double> x = sorted(values);
    return {middle(x), x[rank(x.size(), 0.95)], x.front(), medianInterval(x), x.size()};
}

Ratio medianRatio(std::span<const double> a, std::span<const double> b) {
    ensure(a.size() == b.size(), "a ratio of times needs two of each round");
    std::vector<double> ratios;
    for (size_t i = 0; i < a.size(); ++i)
        if (b[i] > 0) ratios.push_back(a[i] / b[i]);
    if (ratios.empty()) return {1, {1, 1, 0}};
    return {median(ratios), medianInterval(ratios)};
}

std::vector<bool> tradeOffFront(std::span<const TradeOff> points) {
    const auto known = [](const TradeOff& p) { return !std::isnan(p.cost) && !std::isnan(p.error); };
    const auto beats = [&](const TradeOff& a, const TradeOff& b) {
        return known(a) && a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
    };
    std::vector<bool> front;
    for (const TradeOff& p : points)
        front.push_back(known(p) &&
                        std::none_of(points.begin(), points.end(), [&](const TradeOff& q) { return beats(q, p); }));
    return front;
}

} // namespace penumbra
