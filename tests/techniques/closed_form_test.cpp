// SPDX-License-Identifier: MIT
// ψ against scenes whose shadow is known exactly.
#include "renderer/shadow_map/shadow_map.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// A thin slab over x < 0 at height h, light of half width a at height H, receiver at height 0.
constexpr float a = 0.5f, H = 10, h = 6;

Session halfPlane(std::string_view technique) {
    Session s = session(SceneBuilder().floor(2.5f).box({-4, h - 0.01f, -4}, {0, h, 4}).build(), technique);
    s.light = {.position = {0, H, 0}, .target = {0, 0, 0}, .size = {2 * a, 2 * a}};
    s.camera = {.eye = {3, 3, 0}, .target = {0, 0, 0}, .fovY = 40};
    s.size = {160, 120};
    return s;
}

double closedForm(double x) { return 1 - std::clamp((a + x * (H - h) / h) / (2 * a), 0.0, 1.0); }

struct Error {
    double rmse, outside;
    int pixels;
};

// Over the penumbra, and the largest error beyond it (a texel's width of the edge left out).
Error errorOf(const Session& s) {
    const ShadowImage image = draw(s);
    double squares = 0, outside = 0;
    int pixels = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            if (!image.surface(x, y) || image.positionWorld(x, y).y > 1) continue;
            const double place = image.positionWorld(x, y).x, expected = closedForm(place);
            const double difference = image.at(x, y) - expected;
            if (expected > 0 && expected < 1)
                squares += difference * difference, ++pixels;
            else if (std::abs(std::abs(place) - 0.75) > 0.03)
                outside = std::max(outside, std::abs(difference));
        }
    return {std::sqrt(squares / std::max(pixels, 1)), outside, pixels};
}

} // namespace

TEST_CASE("PCSS with 64 and 64 taps meets the half plane under a square light") {
    Session s = halfPlane("pcss");
    s.techniques.assign("pcss.search-taps=64");
    s.techniques.assign("pcss.filter-taps=64");
    for (const bool shifted : {true, false}) {
        s.techniques.assign(shifted ? "rotate=true" : "rotate=false");
        const Error error = errorOf(s);
        CAPTURE(shifted, error.rmse, error.outside);
        CHECK(error.pixels > 2000);
        CHECK(error.rmse < 0.02);
        CHECK(error.outside < 0.02);
    }
}

TEST_CASE("soft variance and moments meet the half plane under a square light, in however many cells") {
    for (const char* technique : {"vsm-soft", "msm-soft"})
        for (const char* cells : {"1", "3"}) {
            Session s = halfPlane(technique);
            s.techniques.assign(std::string("cells=") + cells);
            const Error error = errorOf(s);
            CAPTURE(technique, cells, error.rmse, error.outside);
            CHECK(error.rmse < 0.02);
            CHECK(error.outside < 0.02);
        }
}

TEST_CASE("more PCSS taps are closer to the truth, and 16 are already near") {
    double before = 1;
    for (const char* taps : {"4", "16", "64"}) {
        Session s = halfPlane("pcss");
        s.techniques.assign(std::string("pcss.search-taps=") + taps);
        s.techniques.assign(std::string("pcss.filter-taps=") + taps);
        const double rmse = errorOf(s).rmse;
        CAPTURE(taps, rmse);
        CHECK(rmse < before);
        before = rmse;
    }
}

TEST_CASE("a directional light's PCSS penumbra has the width of its cone") {
    // Edge at height h, directional light of angular radius δ straight above: ψ over |x| < h tan δ, linear for a square
    // kernel; a disk's share of a half plane for a disk.
    Session s = halfPlane("pcss");
    s.light.shape = LightShape::Directional;
    s.light.size = {10, 0};
    s.techniques.assign("pcss.search-taps=64");
    s.techniques.assign("pcss.filter-taps=64");
    const ShadowImage image = draw(s);
    const double half = h * std::tan(glm::radians(5.0));
    double squares = 0;
    int pixels = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            if (!image.surface(x, y) || image.positionWorld(x, y).y > 1) continue;
            const double t = image.positionWorld(x, y).x / half;
            if (std::abs(t) >= 1) continue;
            const double expected = (std::acos(t) - t * std::sqrt(1 - t * t)) / M_PI;
            squares += std::pow(image.at(x, y) - expected, 2);
            ++pixels;
        }
    REQUIRE(pixels > 2000);
    CHECK(std::sqrt(squares / pixels) < 0.03);
}

TEST_CASE("hard shadows and PCF have their edge where the centre of the light sees it") {
    for (const char* technique : {"hard", "pcf"}) {
        const ShadowImage image = draw(halfPlane(technique));
        int wrong = 0, pixels = 0;
        for (int y = 0; y < image.psi.height; ++y)
            for (int x = 0; x < image.psi.width; ++x) {
                const glm::vec3 place = image.positionWorld(x, y);
                if (!image.surface(x, y) || place.y > 1 || std::abs(place.x) < 0.1f) continue;
                wrong += std::abs(image.at(x, y) - (place.x < 0 ? 1.0f : 0.0f)) > 1e-6f;
                ++pixels;
            }
        CAPTURE(technique);
        CHECK(pixels > 5000);
        CHECK(wrong == 0);
    }
}

TEST_CASE("a PCF box of n texels has a linear edge n texels wide") {
    Session s = halfPlane("pcf");
    s.techniques.assign("pcf.kernel=31");
    const ShadowImage image = draw(s);
    const Flow& flow = renderer().flow();
    const Inputs inputs{image.view, s.light, {*flow.find("scene.depth"), *flow.find("scene.normal"), {}},
                        nullptr,    0,       renderer().state().occluders(),
                        0,          0};
    const LightViewBlock light = lightView(inputs, {});
    // On the floor, which lies at depth H; the reference plane lies at f.
    const double halfWidth = 0.5 * 31 * 2 * light.window.z / 1024 * H / light.sample_reference.z;
    int pixels = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            const double place = image.positionWorld(x, y).x;
            if (!image.surface(x, y) || image.positionWorld(x, y).y > 1 || std::abs(place) > 2 * halfWidth) continue;
            // The edge itself is known to a texel.
            CHECK(image.at(x, y) == Approx(std::clamp(0.5 - 0.5 * place / halfWidth, 0.0, 1.0)).margin(1.1 / 31));
            ++pixels;
        }
    CHECK(pixels > 100);
}
