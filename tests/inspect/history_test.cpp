// SPDX-License-Identifier: MIT
// Seeing it work: a frame drawn again, images that only explain, a pixel that is followed.
#include "renderer/inspect/probe.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::shared_ptr<const Scene> boxOverFloor() {
    return SceneBuilder().floor(3).box({-0.4f, 0.8f, -0.4f}, {0.4f, 1.0f, 0.4f}).build();
}

struct Bench {
    Session s;
    Bench(std::shared_ptr<const Scene> scene, std::string_view technique) : s(session(std::move(scene), technique)) {
        set("map-size", "256");
        renderer().reset();
    }
    ~Bench() { renderer().inspect({}); }
    void set(std::string_view id, std::string_view value) { s.techniques.parameters().at(id).setText(value); }
    std::vector<float> frame(Turn turn = Turn::Next) {
        renderer().render(s, Timing::Off, turn);
        return renderer().read(renderer().shadow()).values;
    }
    std::vector<float> channel(std::string_view label, size_t channel) const {
        const Renderer::Pixels p = renderer().readPicture(*renderer().flow().find(label));
        std::vector<float> values;
        for (size_t i = channel; i < p.values.size(); i += static_cast<size_t>(p.channels))
            values.push_back(p.values[i]);
        return values;
    }
};

// Of the names of temporal.state.
constexpr float noSurface = 0, samples = 1, neighbours = 3, wasOffScreen = 4, anotherDepth = 5, nothingThere = 6,
                moversShadow = 7;

} // namespace

TEST_CASE("a frame drawn again is the same, and what was changed meanwhile leaves no trace") {
    // The other's history is of one view: seen from elsewhere it is lost.
    for (const std::string technique : {"temporal", "light-sampling"})
        for (const bool moves : {false, true}) {
            CAPTURE(technique, moves);
            Bench b(moves ? wavingScene() : boxOverFloor(), technique);
            b.s.progressive = true;
            std::array<std::vector<float>, 6> undisturbed;
            const auto play = [&](size_t i) {
                b.s.time = moves ? 0.1 + 0.03 * static_cast<double>(i) : 0;
                return b.frame();
            };
            for (size_t i = 0; i < undisturbed.size(); ++i) undisturbed[i] = play(i);
            renderer().reset();
            for (size_t i = 0; i < undisturbed.size(); ++i) {
                CHECK((play(i) == undisturbed[i]));
                const int length = renderer().flow().historyLength();
                CHECK((b.frame(Turn::Again) == undisturbed[i]));
                if (technique == "light-sampling") continue;
                const Camera camera = b.s.camera;
                b.s.camera.eye.x += 0.3f;
                b.s.time += 0.2;
                (void)b.frame(Turn::Again);
                b.s.camera = camera;
                (void)b.frame(Turn::Again);
                b.s.time -= 0.2;
                CHECK((b.frame(Turn::Again) == undisturbed[i]));
                CHECK(renderer().flow().historyLength() == length);
            }
            if (technique == "temporal") continue;
            b.s.camera.eye.x += 0.3f;
            (void)b.frame(Turn::Again);
            CHECK(renderer().flow().historyLength() == 1);
        }
}

TEST_CASE("images that explain change nothing of the picture, and tell what becomes of a history and why") {
    Bench b(boxOverFloor(), "temporal");
    b.set("overscan", "0");
    b.set("radius-scale", "0.5");
    const std::vector<float> plain = b.frame();
    CHECK_FALSE(renderer().flow().find("temporal.state").has_value());
    renderer().inspect({.images = true});
    renderer().reset();
    CHECK((b.frame() == plain));
    const std::vector<float> depth = b.channel("scene.depth", 0);
    const auto kinds = [&] { return b.channel("temporal.state", 0); };
    const std::vector<float> first = kinds();
    for (size_t i = 0; i < first.size(); ++i) REQUIRE(first[i] == (depth[i] > 0 ? nothingThere : noSurface));

    for (int i = 0; i < 20; ++i) (void)b.frame();
    const std::vector<float> rest = kinds(), filtered = b.channel("temporal.state", 1),
                             error = b.channel("temporal.state", 2);
    const std::vector<float> rho = b.channel("temporal.shadow-buffer", 0), n = b.channel("temporal.shadow-buffer", 1);
    int asking = 0;
    for (size_t i = 0; i < rest.size(); ++i) {
        REQUIRE((depth[i] > 0 ? rest[i] >= samples && rest[i] <= neighbours : rest[i] == noSurface));
        REQUIRE((filtered[i] > 0) == (rest[i] > samples));
        REQUIRE((filtered[i] == 1) == (rest[i] == neighbours));
        asking += filtered[i] > 0;
        if (depth[i] <= 0) continue;
        const double psi = rho[i] / n[i]; // eq. 3
        REQUIRE(error[i] == Approx(std::sqrt(psi * (1 - psi) / (n[i] - 1))).margin(1e-3));
    }
    CHECK(asking > 50);

    b.s.camera.eye.x += 0.8f, b.s.camera.target.x += 0.8f;
    (void)b.frame();
    const std::vector<float> aside = kinds();
    const auto count = [&](float kind) { return std::count(aside.begin(), aside.end(), kind); };
    CHECK(count(wasOffScreen) > 20);  // along an edge
    CHECK(count(anotherDepth) > 5);   // beside the box
    CHECK(count(anotherDepth) < 400); // of 3072
    for (size_t y = 16; y < 32; ++y)
        for (size_t x = 24; x < 40; ++x) CHECK(aside[64 * y + x] != wasOffScreen);

    b.set("neighbourhood", "off");
    (void)b.frame();
    for (const float share : b.channel("temporal.state", 1)) REQUIRE(share == 0);
}

TEST_CASE("the shadow of something that moves is told from what else is new") {
    Bench b(wavingScene(), "temporal");
    renderer().inspect({.images = true});
    for (int i = 0; i < 4; ++i) b.s.time = 0.1 + 0.05 * i, (void)b.frame();
    const std::vector<float> kinds = b.channel("temporal.state", 0), depth = b.channel("temporal.shadow-buffer", 2);
    int movers = 0;
    for (size_t i = 0; i < kinds.size(); ++i) {
        REQUIRE((kinds[i] == moversShadow) == (depth[i] < 0));
        movers += depth[i] < 0;
    }
    CHECK(movers > 20);
}

TEST_CASE("a followed pixel tells its tests, which add up to what is shown, and where on the light they went") {
    Bench b(boxOverFloor(), "temporal");
    b.set("start", "hard");
    b.set("neighbourhood", "off");
    const std::vector<float> soft = [&] {
        for (int i = 0; i < 40; ++i) (void)b.frame();
        return b.frame();
    }();
    const auto penumbra = static_cast<int>(
        std::find_if(soft.begin(), soft.end(), [](float psi) { return psi > 0.3f && psi < 0.7f; }) - soft.begin());
    REQUIRE(penumbra < 64 * 48);
    const glm::ivec2 pixel(penumbra % 64, penumbra / 64);

    Probe probe;
    probe.follow((glm::dvec2(pixel) + 0.5) / glm::dvec2(64, 48));
    REQUIRE(probe.pixel({64, 48}) == glm::ivec2(pixel.x, 47 - pixel.y));
    const auto look = [&](Turn turn = Turn::Next) {
        renderer().inspect({.images = true, .probe = probe.pixel(b.s.size)});
        const float shown = b.frame(turn)[static_cast<size_t>(penumbra)];
        probe.look(renderer(), b.s.techniques.technique().probePlots(), "temporal");
        glFinish();
        probe.take();
        return shown;
    };
    renderer().reset();
    double sum = 0;
    for (int n = 1; n <= 24; ++n) {
        const float shown = look();
        REQUIRE(probe.samples().size() == static_cast<size_t>(n));
        const Probe::Sample& sample = probe.samples().back();
        CHECK(sample.frame == n);
        const auto [tau, estimate, error, told, x, y, hidden] =
            std::array{sample.values[0], sample.values[1], sample.values[2], sample.values[3],
                       sample.values[4], sample.values[5], sample.values[6]};
        REQUIRE((tau == 0 || tau == 1));
        sum += double(tau);
        CHECK(estimate == Approx(sum / n).margin(1e-3));
        CHECK(told == shown);
        CHECK(told == Approx(sum / n).margin(1e-6));
        CHECK((error >= 0 && error <= 1));
        CHECK((std::abs(x) <= 1 && std::abs(y) <= 1));
        CHECK(hidden == tau);
    }
    CHECK((sum > 4 && sum < 20)); // it does lie in a penumbra
    (void)look(Turn::Again);
    CHECK(probe.samples().size() == 24);

    b.set("neighbourhood", "poisson");
    b.set("taps", "12");
    b.set("radius-scale", "0.5");
    renderer().reset();
    for (int i = 0; i < 3; ++i) (void)look();
    CHECK(probe.samples().size() == 3);
    const std::vector<float>& around = probe.row();
    REQUIRE(around.size() == 3 * 64);
    int asked = 0, counted = 0;
    for (size_t i = 0; i < around.size(); i += 3) asked += around[i + 2] >= 0, counted += around[i + 2] > 0;
    CHECK(asked == 12);
    CHECK(counted > 6); // of one plane

    probe.letGo();
    (void)look();
    CHECK(probe.samples().empty());
}
