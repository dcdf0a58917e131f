// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "ui/chart_scale.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace penumbra;

namespace {

std::vector<double> listOf(const Ticks& ticks) { return {ticks.begin(), ticks.end()}; }

} // namespace

TEST_CASE("an axis holds its values, from 0 on or with room on both sides") {
    const std::vector<double> values{2, 0.5, 40};
    const ChartAxis linear = fitAxis(values, false);
    CHECK(linear.from == 0);
    CHECK(linear.to > 40);
    CHECK(linear.position(linear.to / 2) == Approx(0.5));
    const ChartAxis logarithmic = fitAxis(values, true);
    CHECK(logarithmic.from < 0.5);
    CHECK(logarithmic.to > 40);
    for (const double value : values) {
        CHECK(linear.position(value) > 0);
        CHECK(linear.position(value) < 1);
        CHECK(logarithmic.position(value) > 0);
        CHECK(logarithmic.position(value) < 1);
    }
    // Equal factors are equal distances.
    CHECK(logarithmic.position(4) - logarithmic.position(2) ==
          Approx(logarithmic.position(20) - logarithmic.position(10)));
}

TEST_CASE("an axis of one value, of none, of zeros or of what is not finite is drawn too") {
    const std::vector<std::vector<double>> lists{{}, {0}, {7}, {7, 7}, {std::nan(""), INFINITY, -1}, {1e-9}, {1e12}};
    for (const auto& values : lists)
        for (const bool logarithmic : {false, true}) {
            const ChartAxis axis = fitAxis(values, logarithmic);
            CHECK(axis.to > axis.from);
            CHECK(std::isfinite(axis.position(7)));
            CHECK(axis.position(-1) == 0);
            CHECK_FALSE(ticksOf(axis, 6).empty());
        }
    const ChartAxis one = fitAxis(std::vector<double>{7}, true);
    CHECK(one.to >= 2 * one.from);
    CHECK(one.position(7) == Approx(0.5).margin(0.1));
}

TEST_CASE("ticks are round numbers within the axis, no more than fit") {
    CHECK(listOf(ticksOf({0, 1, false}, 5)) == std::vector<double>{0, 0.2, 0.4, 0.2 * 3, 0.8, 1});
    CHECK(listOf(ticksOf({0, 43, false}, 5)) == std::vector<double>{0, 10, 20, 30, 40});
    CHECK(listOf(ticksOf({0.4, 50, true}, 9)) == std::vector<double>{0.5, 1, 2, 5, 10, 20, 50});
    CHECK(listOf(ticksOf({0.4, 50, true}, 5)) == std::vector<double>{1, 3, 10, 30});
    CHECK(listOf(ticksOf({0.0001, 10000, true}, 4)) == std::vector<double>{0.0001, 0.01, 1, 100, 10000});
    CHECK(listOf(ticksOf({10, 20, true}, 5)) == std::vector<double>{10, 12, 14, 16, 18, 20});
    for (const bool logarithmic : {false, true})
        for (double from = 1e-6; from < 1e6; from *= 7.3)
            for (double factor = 2; factor < 1e7; factor *= 3.1)
                for (const int room : {2, 5, 12}) {
                    const ChartAxis axis{logarithmic ? from : 0, from * factor, logarithmic};
                    const Ticks ticks = ticksOf(axis, room);
                    INFO(axis.from << " to " << axis.to << (logarithmic ? " logarithmic" : "") << ", room " << room);
                    CHECK(ticks.size() <= static_cast<size_t>(room) + 2);
                    CHECK(std::is_sorted(ticks.begin(), ticks.end()));
                    for (const double tick : ticks) {
                        CHECK(tick >= axis.from * (1 - 1e-6));
                        CHECK(tick <= axis.to * (1 + 1e-6));
                    }
                }
}
