// SPDX-License-Identifier: MIT
// Fractional-disk soft shadows: their disk, their pre-processing, their tests.
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::shared_ptr<const Scene> twoBoxes() {
    return SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).box({0.2f, 0.8f, 0.2f}, {0.9f, 1.0f, 1.4f}).build();
}

struct Bench {
    Session s;
    explicit Bench(std::shared_ptr<const Scene> scene = twoBoxes()) : s(session(std::move(scene), "fractional-disk")) {
        s.light.shape = LightShape::Disk;
    }
    void set(std::string_view id, std::string_view value) { s.techniques.parameters().at(id).setText(value); }
    std::vector<float> psi() const { return draw(s).psi.values; }
    // With the same map and bias.
    std::vector<float> hard() {
        const ParameterSet& own = s.techniques.parameters();
        s.techniques.choose("hard");
        for (const char* id : {"map-size", "faces", "depth-bias", "slope-bias", "normal-offset"})
            s.techniques.parameters().at(id).set(own.at(id).value());
        const std::vector<float> values = psi();
        s.techniques.choose("fractional-disk");
        return values;
    }
    static Renderer::Pixels image(std::string_view name) {
        return renderer().read(*renderer().flow().find("fractional-disk." + std::string(name)));
    }
};

int differing(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    int count = 0;
    for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
    return count;
}

// A thin closed slab over x < 0 at height h, a disk light of radius r at height H, the floor at height 0.
constexpr float r = 0.5f, H = 10, h = 6;

Bench halfPlane() {
    Bench b(SceneBuilder().floor(2.5f).box({-4, h - 0.01f, -4}, {0, h, 4}).build());
    b.s.light.position = {0, H, 0};
    b.s.light.size = {2 * r, 2 * r};
    b.s.camera = {.eye = {3, 3, 0}, .target = {0, 0, 0}, .fovY = 40};
    b.s.size = {160, 120};
    return b;
}

// The hidden share of a disk light beyond an edge over x = 0 (of the slab's lower face, which casts).
double closedForm(double x) {
    const double d1 = H - (h - 0.01), d2 = h - 0.01, t = std::clamp(x / (r * d2 / d1), -1.0, 1.0);
    return (std::acos(t) - t * std::sqrt(1 - t * t)) / M_PI;
}

struct ProfileError {
    double meanAbsolute, rms; // over the penumbra
    int pixels;
};

ProfileError profileError(const Bench& b) {
    const ShadowImage image = draw(b.s);
    double sum = 0, squares = 0;
    int pixels = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            if (!image.surface(x, y) || image.positionWorld(x, y).y > 1) continue;
            const double expected = closedForm(image.positionWorld(x, y).x);
            if (expected <= 0 || expected >= 1) continue;
            const double error = std::abs(image.at(x, y) - expected);
            sum += error, squares += error * error, ++pixels;
        }
    REQUIRE(pixels > 2000);
    return {sum / pixels, std::sqrt(squares / pixels), pixels};
}

} // namespace

TEST_CASE("a light of no radius casts the hard shadow of the same faces and bias") {
    Bench b;
    b.s.size = {160, 120};
    b.set("slope-bias", "0.5"); // front faces then need no luck
    for (const LightShape shape : {LightShape::Disk, LightShape::Rectangle, LightShape::Directional})
        for (const char* faces : {"back", "front", "both"}) {
            b.s.light.shape = shape;
            b.s.light.size = {0, 0};
            b.set("faces", faces);
            const std::vector<float> hard = b.hard();
            CAPTURE(int(shape), faces);
            b.set("distance", "axial");
            CHECK(differing(b.psi(), hard) == 0);
            // The same test in other numbers.
            b.set("distance", "fragment");
            CHECK(differing(b.psi(), hard) <= 4);
            b.s.light.size = {1, 1};
            b.set("light-scale", "0");
            CHECK(differing(b.psi(), hard) <= 4);
            b.set("light-scale", "1");
        }
}

TEST_CASE("a half plane's penumbra is the closed form, with complete sets and with the published noise") {
    Bench b = halfPlane();
    b.set("texels-per-sample", "0.05"); // 64 samples wherever it filters
    for (const char* distance : {"fragment", "axial"})
        for (const char* preparation : {"flood", "separable", "none-corrected"}) {
            CAPTURE(distance, preparation);
            b.set("distance", distance);
            b.set("pre-processing", preparation);
            b.set("noise", "constants");
            CHECK(profileError(b).meanAbsolute < 0.02);
            b.set("noise", "random-start");
            CHECK(profileError(b).meanAbsolute < 0.04);
        }
}
