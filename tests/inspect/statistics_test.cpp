// SPDX-License-Identifier: MIT
// Ranges that follow from values.
#include "tests/catch.h"

#include "renderer/inspect/statistics.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace penumbra;

namespace {

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float most = std::numeric_limits<float>::max();

} // namespace

TEST_CASE("the automatic range goes from the 1st to the 99th percentile of the finite values") {
    std::vector<float> values;
    for (int i = 0; i <= 1000; ++i) values.push_back(static_cast<float>(i));
    for (int i = 0; i < 500; ++i) values.insert(values.end(), {notANumber, infinity, -infinity});
    std::shuffle(values.begin(), values.end(), std::mt19937(3));
    const auto range = quantileRange(values);
    REQUIRE(range);
    CHECK(range->min == 10);
    CHECK(range->max == 990);
}

TEST_CASE("a few strays do not stretch the automatic range, but are all there is to see beside one value") {
    std::vector<float> values(1000);
    for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    values[17] = 1e30f;
    CHECK(quantileRange(values)->max < 1000);

    values.assign(1000, 0.0f);
    values[17] = 0.5f;
    CHECK(*quantileRange(values) == ValueRange{0, 0.5f});
}

TEST_CASE("without finite values there is no range") {
    std::vector<float> values{notANumber, infinity};
    CHECK_FALSE(quantileRange(values));
    CHECK_FALSE(quantileRange({}));
    CHECK_FALSE(Statistics().extremes());
}

TEST_CASE("a range that is to be looked at is never empty") {
    for (const float value : {0.0f, 3.0f, -2.0f, 1e-30f, 1e-45f, most, -most}) {
        const ValueRange range = nonEmpty({value, value});
        CAPTURE(value);
        CHECK(range.min < range.max);
        CHECK(range.min <= value);
        CHECK(value <= range.max);
        CHECK(std::isfinite(range.min));
        CHECK(std::isfinite(range.max));
    }
    CHECK(nonEmpty({1, 2}) == ValueRange{1, 2});
    const ValueRange all = widened({-most, most}, 0.1);
    CHECK(std::isfinite(all.max - 0.5f * all.max));
}
