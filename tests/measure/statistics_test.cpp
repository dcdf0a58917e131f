// SPDX-License-Identifier: MIT
#include "renderer/measure/statistics.h"
#include "tests/catch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

using namespace penumbra;

namespace {

std::vector<double> upTo(size_t n) { // n, n - 1 ... 1
    std::vector<double> values(n);
    std::iota(values.rbegin(), values.rend(), 1.0);
    return values;
}

} // namespace

TEST_CASE("medians and percentiles by hand") {
    CHECK(median({}) == 0);
    CHECK(median(std::vector{3.0}) == 3);
    CHECK(median(std::vector{5.0, 1.0, 3.0}) == 3);
    CHECK(median(std::vector{4.0, 1.0, 3.0, 2.0}) == 2.5);
    CHECK(percentile({}, 0.95) == 0);
    CHECK(percentile(upTo(100), 0.95) == 95);
    CHECK(percentile(upTo(20), 0.95) == 19);
    CHECK(percentile(upTo(10), 0.95) == 10);
    CHECK(percentile(upTo(10), 1) == 10);
    CHECK(percentile(std::vector{7.0}, 0.5) == 7);
}

TEST_CASE("the interval of a median is that of the tables of binomial order statistics") {
    struct Row {
        size_t n, k; // x(k), x(n + 1 - k)
        double coverage;
    };
    // 1 - 2 P(B(n, 1/2) < k), for the largest k that leaves 0.95.
    for (const Row& row : {Row{6, 1, 0.96875}, Row{9, 2, 0.9609375}, Row{10, 2, 0.978515625}, Row{20, 6, 0.958610535},
                           Row{50, 18, 0.967160872}, Row{100, 40, 0.964799800}}) {
        INFO(row.n << " values");
        const Interval interval = medianInterval(upTo(row.n));
        CHECK(interval.low == static_cast<double>(row.k));
        CHECK(interval.high == static_cast<double>(row.n + 1 - row.k));
        CHECK(interval.coverage == Approx(row.coverage).epsilon(1e-8));
    }
}

TEST_CASE("few values give their range and say how little that tells") {
    const Interval five = medianInterval(upTo(5));
    CHECK(five.low == 1);
    CHECK(five.high == 5);
    CHECK(five.coverage == Approx(0.9375));
    const Interval one = medianInterval(upTo(1));
    CHECK(one.low == 1);
    CHECK(one.high == 1);
    CHECK(one.coverage == Approx(0));
    CHECK(medianInterval({}).coverage == 0);
}

TEST_CASE("the interval holds the median as often as it says") {
    std::mt19937 generator(1);
    std::exponential_distribution<double> skewed; // of median ln 2
    for (const size_t n : {7, 20, 51}) {
        constexpr int experiments = 4000;
        int held = 0;
        double coverage = 0;
        for (int e = 0; e < experiments; ++e) {
            std::vector<double> values(n);
            std::generate(values.begin(), values.end(), [&] { return skewed(generator); });
            const Interval interval = medianInterval(values);
            coverage = interval.coverage;
            held += interval.low <= std::log(2.0) && std::log(2.0) <= interval.high;
        }
        INFO(n << " values, coverage " << coverage);
        CHECK(coverage >= 0.95);
        CHECK(held / double(experiments) == Approx(coverage).margin(0.015)); // 4 standard errors
    }
}

TEST_CASE("the interval of many values is as narrow as theory has it") {
    const Interval interval = medianInterval(upTo(10001));
    CHECK(interval.low == Approx(5001 - 98).margin(2)); // ± 1.96 √n / 2
    CHECK(interval.high == Approx(5001 + 98).margin(2));
    CHECK(interval.coverage >= 0.95);
    CHECK(interval.coverage < 0.9524); // a rank more on both sides is 0.0023 of probability
}

TEST_CASE("a summary of times") {
    const TimeSummary summary = summarise(upTo(20));
    CHECK(summary.median == 10.5);
    CHECK(summary.p95 == 19);
    CHECK(summary.min == 1);
    CHECK(summary.count == 20);
    CHECK(summary.interval.low == 6);
    CHECK(summarise({}).count == 0);
}

TEST_CASE("a drift that hits both does not hide a difference, and noise is none") {
    std::mt19937 generator(2);
    std::normal_distribution<double> noise(0, 0.01);
    std::vector<double> a, b, same;
    for (int i = 0; i < 21; ++i) {
        const double drift = 10 * (1 + 0.1 * i); // the machine gets three times as slow
        a.push_back(1.1 * drift * (1 + noise(generator)));
        b.push_back(drift * (1 + noise(generator)));
        same.push_back(drift * (1 + noise(generator)));
    }
    const Ratio slower = medianRatio(a, b);
    CHECK(slower.median == Approx(1.1).margin(0.01));
    CHECK(slower.differs());
    CHECK(medianRatio(b, a).differs());
    CHECK_FALSE(medianRatio(b, same).differs());
    CHECK_FALSE(medianRatio(b, b).differs());
}

TEST_CASE("a difference seen in five rounds is none yet, in six it is") {
    const std::vector<double> two(6, 2), one(6, 1);
    CHECK_FALSE(medianRatio({two.data(), 5}, {one.data(), 5}).differs());
    CHECK(medianRatio(two, one).differs());
    CHECK(medianRatio({}, {}).median == 1);
    CHECK_FALSE(medianRatio({}, {}).differs());
    const std::vector<double> zero(6, 0);
    CHECK_FALSE(medianRatio(two, zero).differs());
}

TEST_CASE("rounds without noise differ from nothing about as often as they may") {
    std::mt19937 generator(3);
    std::exponential_distribution<double> skewed;
    int found = 0;
    constexpr int experiments = 2000;
    for (int e = 0; e < experiments; ++e) {
        std::vector<double> a(20), b(20);
        for (size_t i = 0; i < a.size(); ++i) a[i] = 1 + skewed(generator), b[i] = 1 + skewed(generator);
        found += medianRatio(a, b).differs();
    }
    CHECK(found / double(experiments) == Approx(1 - 0.9586).margin(0.02));
}

TEST_CASE("the front is who is beaten by nobody") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<TradeOff> points{{1, 0.5}, {2, 0.3},   {3, 0.3},   {2.5, 0.4},
                                       {4, 0.1}, {nan, 0.0}, {0.5, nan}, {4, 0.1}};
    CHECK(tradeOffFront(points) == std::vector<bool>{true, true, false, false, true, false, false, true});
    CHECK(tradeOffFront({}).empty());
}
