// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "ui/image_mapping.h"
#include "ui/timings_panel.h"

#include <limits>
#include <random>

using namespace penumbra;

namespace {

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

std::array<int, 4> at(const std::vector<uint8_t>& rgba, int width, int x, int y) {
    const uint8_t* p = rgba.data() + 4 * (y * width + x);
    return {p[0], p[1], p[2], p[3]};
}

} // namespace

TEST_CASE("the automatic range goes from the 1st to the 99th percentile of the finite values") {
    Renderer::Pixels pixels{1000, 500, 2, {}};
    std::mt19937 random(7);
    for (int i = 0; i < 1000 * 500; ++i) {
        const float uniform = std::uniform_real_distribution<float>(0, 100)(random);
        pixels.values.push_back(-1);
        pixels.values.push_back(i % 50 == 0 ? notANumber : i % 51 == 0 ? infinity : uniform);
    }
    std::vector<float> scratch;
    const ValueRange range = quantileRange(pixels, 1, 0.01, 0.99, scratch);
    CHECK(range.min == Approx(1).margin(0.2));
    CHECK(range.max == Approx(99).margin(0.2));
}

TEST_CASE("a range is never empty") {
    std::vector<float> scratch;
    for (const float value : {0.0f, 3.0f, -2.0f, notANumber, infinity, 1e-30f}) {
        const ValueRange range = quantileRange({2, 1, 1, {value, value}}, 0, 0.01, 0.99, scratch);
        CAPTURE(value);
        CHECK(range.min < range.max);
        if (std::isfinite(value)) {
            CHECK(range.min <= value);
            CHECK(value <= range.max);
        }
    }
}

TEST_CASE("texels that are no numbers are counted once each") {
    const Renderer::Pixels pixels{2, 2, 2, {notANumber, notANumber, infinity, 1, notANumber, -infinity, 0, 0}};
    const BadTexels bad = countBadTexels(pixels);
    CHECK(bad.nan == 2);
    CHECK(bad.infinite == 2);
}

TEST_CASE("the view shows grey, colours, NaN, infinity and the outside apart") {
    const Renderer::Pixels pixels{3, 2, 1, {0, 0.5f, 1, notANumber, infinity, 7}};
    std::vector<uint8_t> rgba;
    mapToRgba(pixels, {-1, 0, 1}, {0, 0, 0}, {0, 1}, 5, 2, rgba);
    CHECK(at(rgba, 5, 0, 0) == std::array{0, 0, 0, 0});
    CHECK(at(rgba, 5, 1, 0) == std::array{0, 0, 0, 255});
    CHECK(at(rgba, 5, 2, 0) == std::array{128, 128, 128, 255});
    CHECK(at(rgba, 5, 3, 0) == std::array{255, 255, 255, 255});
    CHECK(at(rgba, 5, 4, 0) == std::array{0, 0, 0, 0});
    CHECK(at(rgba, 5, 1, 1) == std::array{255, 0, 255, 255});
    CHECK(at(rgba, 5, 2, 1) == std::array{0, 255, 255, 255});
    CHECK(at(rgba, 5, 3, 1) == std::array{255, 255, 255, 255});

    const Renderer::Pixels colour{1, 1, 3, {1, 0.5f, 0}};
    mapToRgba(colour, {0, 0, 4}, {0, 1, 2}, {0, 1}, 4, 4, rgba);
    CHECK(at(rgba, 4, 3, 3) == std::array{255, 128, 0, 255});
}

TEST_CASE("a range over all of float is still shown") {
    const float most = std::numeric_limits<float>::max();
    std::vector<uint8_t> rgba;
    mapToRgba({3, 1, 1, {-most, 0, most}}, {0, 0, 1}, {0, 0, 0}, {-most, most}, 3, 1, rgba);
    CHECK(at(rgba, 3, 0, 0)[0] == 0);
    CHECK(at(rgba, 3, 1, 0)[0] == 128);
    CHECK(at(rgba, 3, 2, 0)[0] == 255);
}

TEST_CASE("the median window forgets what is older than 60 frames") {
    MedianWindow window;
    CHECK(window.median() == 0);
    window.add(5);
    CHECK(window.median() == 5);
    for (int i = 0; i < 59; ++i) window.add(1);
    window.add(1000); // one slow frame does not show
    CHECK(window.median() == 1);
    for (int i = 0; i < 60; ++i) window.add(2);
    CHECK(window.median() == 2);
}
