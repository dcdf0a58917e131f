// SPDX-License-Identifier: MIT
// The other truth: the mean of many shadow maps, against closed forms and against the rays.
#include "renderer/shadow_map/shadow_map.h"
#include "renderer/truth/sampled_truth.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"
#include "tests/truth/closed_forms.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

struct Error {
    double rmse = 0, most = 0;
    void add(double difference) {
        rmse += difference * difference;
        most = std::max(most, std::abs(difference));
    }
};
struct Errors {
    Error all;        // of ψ
    Error sampling;   // of N perfect hard shadows
    Error maps;       // what the maps add to it
    int pixels = 0;   // of the penumbra
    double texel = 0; // on the floor [m]
};

Errors errorsOf(const ClosedForm& form, glm::ivec2 size, int maps, int mapSize) {
    Session s = closedFormSession(form, size);
    s.techniques.choose("light-sampling");
    s.techniques.parameters().at("samples").set(maps);
    s.techniques.parameters().at("map-size").set(mapSize);
    std::vector<glm::dvec2> points; // light space has x along world x, y along −z
    for (int i = 0; i < maps; ++i) {
        const glm::vec2 point = lightPoint(s.light, sobolPoint(static_cast<uint32_t>(i), 0));
        points.push_back({point.x, -point.y});
    }
    const ShadowImage image = draw(s);
    Errors errors;
    const Flow& flow = renderer().flow();
    const Inputs inputs{image.view, s.light, {*flow.find("scene.depth"), *flow.find("scene.normal"), {}},
                        nullptr,    0,       renderer().state().occluders(),
                        0,          0};
    const LightViewBlock light = lightView(inputs, {.size = mapSize});
    errors.texel = 2 * light.window.z / mapSize * 10 / light.sample_reference.z; // the floor is at depth 10
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            const glm::vec3 position = image.positionWorld(x, y);
            if (!image.surface(x, y) || !onKnownFloor(position)) continue;
            const double exact = form.psi(position);
            double sampled = 0;
            for (const glm::dvec2 point : points) sampled += form.hides(position, point) ? 1 : 0;
            sampled /= maps;
            if (exact < 0.01 || exact > 0.99) {
                errors.all.most = std::max(errors.all.most, std::abs(image.at(x, y) - exact));
                continue;
            }
            errors.all.add(image.at(x, y) - exact);
            errors.sampling.add(sampled - exact);
            errors.maps.add(image.at(x, y) - sampled);
            ++errors.pixels;
        }
    for (Error* error : {&errors.all, &errors.sampling, &errors.maps})
        error->rmse = std::sqrt(error->rmse / errors.pixels);
    return errors;
}

} // namespace

TEST_CASE("light-source sampling meets the closed forms as far as its maps are many and fine") {
    // What N points miss of a share of the light is known exactly; what is left is the maps' own. In each map a point
    // of the light is misjudged if its edge passes between the pixel and the centre of its texel: at most t/3 on
    // average over places and directions, which is a band of that times (H − h)/h on the light, as long as its width or
    // (a disk's) 4/π of it, for each of two edges: a share p ≤ 2 · t/3 · 2/3 · 4/π. Either side is as likely and the
    // grids differ from map to map, so the errors add like coins: √(p / N).
    constexpr int maps = 128;
    for (const ClosedForm& form : closedForms) {
        double before = 1;
        for (const int size : {256, 1024}) {
            const Errors errors = errorsOf(form, {120, 90}, maps, size);
            const double p = 2 * errors.texel / 3 * 2 / 3 * 4 / M_PI;
            CAPTURE(form.scene, size, errors.texel, errors.all.rmse, errors.sampling.rmse, errors.maps.rmse);
            CHECK(errors.pixels > 300);
            CHECK(errors.maps.rmse < std::sqrt(p / maps));
            CHECK(errors.maps.rmse < before);
            CHECK(errors.all.rmse < errors.sampling.rmse + errors.maps.rmse);
            before = errors.maps.rmse;
        }
    }
}

// The figures that the truth is held to; minutes on a software renderer. test-truth "[figures]"
TEST_CASE("light-source sampling with 1024 maps of 2048x2048 meets the closed forms", "[.][figures]") {
    for (const ClosedForm& form : closedForms) {
        const Errors errors = errorsOf(form, {160, 120}, 1024, 2048);
        WARN(form.scene << ": RMSE " << errors.all.rmse << " over " << errors.pixels << " penumbra pixels, at most "
                        << errors.all.most << "; of the points alone " << errors.sampling.rmse << ", of the maps "
                        << errors.maps.rmse);
        CHECK(errors.all.rmse < 0.005);
        CHECK(errors.all.most < 0.03);
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
