// SPDX-License-Identifier: MIT
// The other truth: the mean of many shadow maps, against closed forms and against the rays.
#include "renderer/truth/sampled_truth.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"
#include "tests/truth/closed_forms.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

struct Error {
    double rmse, most;
    int penumbra;
};

// RMSE over the penumbra, largest error anywhere on the floor.
Error errorOf(const ClosedForm& form, glm::ivec2 size, int maps, int mapSize) {
    Session s = closedFormSession(form, size);
    s.techniques.choose("light-sampling");
    s.techniques.parameters().at("samples").set(maps);
    s.techniques.parameters().at("map-size").set(mapSize);
    const ShadowImage image = draw(s);
    double squares = 0, most = 0;
    int penumbra = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            const glm::vec3 position = image.positionWorld(x, y);
            if (!image.surface(x, y) || !onKnownFloor(position)) continue;
            const double expected = form.psi(position), difference = image.at(x, y) - expected;
            most = std::max(most, std::abs(difference));
            if (expected < 0.01 || expected > 0.99) continue;
            squares += difference * difference;
            ++penumbra;
        }
    return {std::sqrt(squares / penumbra), most, penumbra};
}

} // namespace

TEST_CASE("light-source sampling meets the closed forms as far as its maps are many and fine") {
    // Halton's n = 128 points miss a share of the light cut off by a general edge by an RMSE of about 0.012 (0.0187 at
    // 64, 0.006 at 256: ../shared/algorithms.md 10.5), and by at most their discrepancy, about 0.05.
    for (const ClosedForm& form : closedForms) {
        const Error error = errorOf(form, {120, 90}, 128, 512);
        CAPTURE(form.scene, error.rmse, error.most);
        CHECK(error.penumbra > 300);
        CHECK(error.rmse < 0.012);
        CHECK(error.most < 0.05);
    }
}

// The figures that the truth is held to; minutes on a software renderer. test-truth "[figures]"
TEST_CASE("light-source sampling with 1024 maps of 2048x2048 meets the closed forms", "[.][figures]") {
    for (const ClosedForm& form : closedForms) {
        const Error error = errorOf(form, {160, 120}, 1024, 2048);
        WARN(form.scene << ": RMSE " << error.rmse << " over " << error.penumbra << " penumbra pixels, at most "
                        << error.most);
        CHECK(error.rmse < 0.005);
        CHECK(error.most < 0.03);
    }
}

TEST_CASE("spread over frames it is exactly the mean of the maps so far") {
    Session s = session(SceneBuilder().floor(3).box({-1, 0.5f, -1}, {0, 1, 0}).build(), "light-sampling");
    const auto set = [&](const char* id, double value) { s.techniques.parameters().at(id).set(value); };
    set("map-size", 128), set("maps-per-frame", 4);
    const auto atOnce = [&](int samples) {
        s.progressive = false;
        set("samples", samples);
        return draw(s).psi.values;
    };
    const std::vector<float> four = atOnce(4), twelve = atOnce(12), fourteen = atOnce(14);
    CHECK(four != twelve);

    s.progressive = true; // with 14 samples
    const auto frame = [&] {
        renderer().render(s);
        return renderer().read(renderer().shadow()).values;
    };
    renderer().reset();
    CHECK((frame() == four));
    CHECK(renderer().flow().living());
    frame();
    CHECK((frame() == twelve));
    CHECK(renderer().flow().living());
    CHECK((frame() == fourteen)); // two maps were left
    CHECK_FALSE(renderer().flow().living());
    CHECK((frame() == fourteen));
    CHECK(renderer().flow().passes().size() < 8); // no map is drawn any more
    s.display.show = Show::Lit;                   // ψ does not depend on it
    CHECK((frame() == fourteen));
    s.display.show = Show::Shadow;

    // Whatever ψ depends on starts it anew.
    s.light.position.x += 0.1f;
    const std::vector<float> moved = frame();
    renderer().reset();
    CHECK((frame() == moved));
    s.camera.eye.x += 0.1f;
    frame();
    CHECK(renderer().flow().living());
    frame(), frame(), frame();
    CHECK_FALSE(renderer().flow().living());
    set("depth-bias", 1e-4);
    frame();
    CHECK(renderer().flow().living());
}

TEST_CASE("points of the light below the horizon are hidden") {
    // The side of a box at x = 0.4 sees the light's x in [0.4, 2] of [−2, 2].
    Session s = session(SceneBuilder().box({-0.4f, -0.4f, -0.4f}, {0.4f, 0.4f, 0.4f}).build(), "light-sampling");
    s.progressive = false;
    s.size = {96, 72};
    s.light.size = {4, 4};
    s.techniques.parameters().at("samples").set(256);
    s.techniques.parameters().at("map-size").set(64);
    const ShadowImage image = draw(s);
    int pixels = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            const glm::vec3 p = image.positionWorld(x, y);
            if (!image.surface(x, y) || std::abs(p.x - 0.4f) > 1e-4f || p.y > 0.35f || p.z > 0.35f) continue;
            CHECK(image.at(x, y) == Approx(0.6).margin(0.03));
            ++pixels;
        }
    CHECK(pixels > 50);
}

TEST_CASE("the two truths agree but for the maps' resolution, which the map bias tells") {
    Session s = session(SceneBuilder().floor(3).box({-1, 0.5f, -1}, {0, 1, 0}).build());
    renderer().reset();
    renderer().render(s);
    const Truth traced = traceTruth(readTruthInput(renderer(), s), {.leastSamples = 1024, .mostSamples = 1024});
    double before = 1;
    for (const int size : {32, 128, 512}) {
        const Truth sampled = sampledTruth(renderer(), s, {.maps = 128, .mapSize = size});
        CHECK(sampled.classes == traced.classes);
        CHECK(sampled.samplesMost == 128);
        const double bias = mapBias(traced, sampled);
        CAPTURE(size, bias);
        CHECK(bias < before);
        before = bias;
    }
    CHECK(before < 0.01);
    CHECK(s.techniques.card().id == "hard"); // the session is as it was
    CHECK_FALSE(s.techniques.parametersOf("light-sampling").at("samples").changed());
}
