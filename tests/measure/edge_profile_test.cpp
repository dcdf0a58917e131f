// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "renderer/measure/edge_profile.h"

#include <algorithm>
#include <cmath>

using namespace penumbra;

namespace {

// ψ rises from 0 at `start` to 1 at `end`, both in samples.
std::vector<float> ramp(size_t count, double start, double end) {
    std::vector<float> profile;
    for (size_t i = 0; i < count; ++i)
        profile.push_back(static_cast<float>(std::clamp((static_cast<double>(i) - start) / (end - start), 0.0, 1.0)));
    return profile;
}

// A picture whose pixels are a function of their centres.
template <class F> std::vector<float> image(glm::ivec2 size, F&& f) {
    std::vector<float> pixels;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) pixels.push_back(f(glm::vec2(x, y) + 0.5f));
    return pixels;
}

} // namespace

TEST_CASE("the width of a linear ramp is eight tenths of it, whichever way it runs") {
    for (const double width : {1.0, 3.0, 10.0, 73.5}) {
        std::vector<float> profile = ramp(120, 20.25, 20.25 + width);
        const auto rising = edgeWidth(profile);
        REQUIRE(rising);
        if (width >= 10) { // else the ramp's ends lie between samples, and are cut
            CHECK(rising->samples() == Approx(0.8 * width).epsilon(1e-4));
            CHECK(rising->at10 == Approx(20.25 + 0.1 * width).epsilon(1e-4));
            CHECK(rising->at90 == Approx(20.25 + 0.9 * width).epsilon(1e-4));
        }
        std::reverse(profile.begin(), profile.end());
        const auto falling = edgeWidth(profile);
        REQUIRE(falling);
        CHECK(falling->samples() == Approx(rising->samples()).epsilon(1e-4));
        CHECK(falling->at10 == Approx(119 - rising->at10).epsilon(1e-4));
    }
    // A step between two neighbours is as wide as what lies between them.
    CHECK(edgeWidth(std::vector<float>{0, 0, 1, 1})->samples() == Approx(0.8));
}

TEST_CASE("a profile that does not pass both levels has no width") {
    CHECK_FALSE(edgeWidth({}));
    CHECK_FALSE(edgeWidth(std::vector<float>{0.5f}));
    CHECK_FALSE(edgeWidth(std::vector<float>(50, 0.0f)));
    CHECK_FALSE(edgeWidth(std::vector<float>(50, 1.0f)));
    std::vector<float> half = ramp(100, 10, 90);
    for (float& value : half) value *= 0.85f; // 10 percent alone
    CHECK_FALSE(edgeWidth(half));
    for (float& value : half) value = 0.15f + value; // 90 percent alone
    CHECK_FALSE(edgeWidth(half));
    CHECK_FALSE(edgeWidth(std::vector<float>(50, std::nanf(""))));
}

TEST_CASE("of several edges the one in the middle counts, and only a whole passage") {
    // Up over 5 samples at 10, down over 20 at 60, up again at 130.
    std::vector<float> profile(160);
    for (size_t i = 0; i < profile.size(); ++i) {
        const double x = static_cast<double>(i);
        const double up = std::clamp((x - 10) / 5, 0.0, 1.0), down = std::clamp((x - 60) / 20, 0.0, 1.0),
                     again = std::clamp((x - 130) / 5, 0.0, 1.0);
        profile[i] = static_cast<float>(up - down + again);
    }
    const auto edge = edgeWidth(profile);
    REQUIRE(edge);
    CHECK(edge->at90 == Approx(62).epsilon(1e-4));
    CHECK(edge->at10 == Approx(78).epsilon(1e-4));
    // A dent that comes back over 10 percent without reaching 90 begins the passage anew.
    const std::vector<float> dent{0, 0, 0.2f, 0.05f, 0.5f, 1, 1};
    REQUIRE(edgeWidth(dent));
    CHECK(edgeWidth(dent)->at10 == Approx(3 + 0.05 / 0.45).epsilon(1e-4));
}

TEST_CASE("a line over a picture reads what lies between its pixels' centres") {
    const glm::ivec2 size(40, 30);
    const auto plane = [](glm::vec2 p) { return 0.01f * p.x + 0.02f * p.y; };
    const std::vector<float> pixels = image(size, plane);
    std::vector<float> profile;
    const glm::vec2 from(3.2f, 4.7f), to(31.9f, 22.1f);
    sampleLine(pixels, size, from, to, 57, profile);
    REQUIRE(profile.size() == 57);
    for (size_t i = 0; i < profile.size(); ++i)
        CHECK(profile[i] == Approx(plane(glm::mix(from, to, static_cast<float>(i) / 56))).margin(1e-5));
    sampleLine(pixels, size, {-5, -5}, {-5, -5}, 2, profile);
    CHECK(profile == std::vector<float>{pixels[0], pixels[0]});
    sampleLine(pixels, size, {99, 99}, {99, 99}, 1, profile);
    CHECK(profile == std::vector<float>{pixels.back()});
}

TEST_CASE("a place of the picture is the point of the surface there, to the last millimetre on a plane") {
    const glm::ivec2 size(64, 48);
    const View view = makeView({.eye = {0, 2, 5}, .target = {0, 0, 0}}, size, 0.01f, 100);
    const auto rayOf = [&](glm::vec2 p) {
        return view.rayCorner + p.x * view.rayDx + (static_cast<float>(size.y) - p.y) * view.rayDy;
    };
    // The floor y = 0: eye.y + depth · ray.y = 0.
    const auto depthAt = [&](glm::vec2 p) { return rayOf(p).y < 0 ? -view.eyeWorld.y / rayOf(p).y : 0.0f; };
    std::vector<float> depth = image(size, depthAt);
    for (const glm::vec2 place : {glm::vec2(10.3f, 40.8f), glm::vec2(33.5f, 30.5f), glm::vec2(60.01f, 35.99f)}) {
        const auto point = surfaceWorld(view, depth, place);
        REQUIRE(point);
        const glm::vec3 expected = view.eyeWorld + depthAt(place) * rayOf(place);
        CHECK(glm::distance(*point, expected) < 1e-4f);
    }
    std::fill(depth.begin(), depth.end(), 0.0f);
    CHECK_FALSE(surfaceWorld(view, depth, {10, 40}));
}

TEST_CASE("where a nearer surface ends on the way, the ruler measures no metres") {
    const glm::ivec2 size(64, 48);
    const View view = makeView({.eye = {0, 2, 5}, .target = {0, 0, 0}}, size, 0.01f, 100);
    const auto rayOf = [&](glm::vec2 p) {
        return view.rayCorner + p.x * view.rayDx + (static_cast<float>(size.y) - p.y) * view.rayDy;
    };
    const auto floor = [&](glm::vec2 p) { return rayOf(p).y < 0 ? -view.eyeWorld.y / rayOf(p).y : 0.0f; };
    const glm::vec2 low(30, 46), high(36, 16); // over most of the floor, far into its distance
    const auto isOne = [&](const std::vector<float>& depth) { return onOneSurface(view, depth, low, high); };
    const std::vector<float> plane = image(size, floor);
    REQUIRE(*std::max_element(plane.begin(), plane.end()) > 20);
    CHECK(isOne(plane));
    SECTION("a wall that stands on it goes on from it") {
        const auto wall = [&](glm::vec2 p) { return std::min(floor(p) > 0 ? floor(p) : 100, 6 / -rayOf(p).z); };
        CHECK(isOne(image(size, wall)));
    }
    SECTION("a ball that lies before it does not") {
        // |eye + t ray − centre|² = r²
        const glm::vec3 centre(0, 1, 1), from = view.eyeWorld - centre;
        const auto ball = [&](glm::vec2 p) {
            const glm::vec3 ray = rayOf(p);
            const float a = glm::dot(ray, ray), b = glm::dot(ray, from), c = glm::dot(from, from) - 1;
            const float root = b * b - a * c;
            return root > 0 ? (-b - std::sqrt(root)) / a : floor(p);
        };
        const std::vector<float> depth = image(size, ball);
        CHECK_FALSE(isOne(depth));
        const glm::vec2 middle(32, 24); // and on the ball alone it is one
        CHECK(onOneSurface(view, depth, middle, middle + glm::vec2(6, 2)));
    }
    SECTION("nor does a pole of one pixel, or a board that lies on it") {
        std::vector<float> pole = plane;
        for (size_t x = 0; x < 64; ++x) pole[30 * 64 + x] = 0.5f * plane[30 * 64 + x];
        CHECK_FALSE(isOne(pole));
        std::vector<float> board = plane;
        for (size_t y = 30; y < 40; ++y)
            for (size_t x = 0; x < 64; ++x) board[y * 64 + x] *= 0.9f;
        CHECK_FALSE(isOne(board));
    }
    SECTION("nor does the sky") {
        std::vector<float> sky = plane;
        std::fill(sky.begin(), sky.begin() + 20 * 64, 0.0f);
        CHECK_FALSE(isOne(sky));
        CHECK(onOneSurface(view, sky, low, low));
    }
}
