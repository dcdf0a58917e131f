// SPDX-License-Identifier: MIT
// Soft shadows by temporal coherence: what their histories hold, keep and forget.
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <cmath>
#include <limits>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::shared_ptr<const Scene> twoBoxes() {
    return SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).box({0.2f, 0.8f, 0.2f}, {0.9f, 1.0f, 1.4f}).build();
}

struct Bench {
    Session s;
    explicit Bench(std::shared_ptr<const Scene> scene = twoBoxes()) : s(session(std::move(scene), "temporal")) {
        set("map-size", "256");
        renderer().reset();
    }
    void set(std::string_view id, std::string_view value) { s.techniques.parameters().at(id).setText(value); }
    void samplesAlone() {
        set("start", "hard");
        set("neighbourhood", "off");
    }
    std::vector<float> frame() {
        renderer().render(s);
        return renderer().read(renderer().shadow()).values;
    }
    std::vector<float> frames(int n) {
        for (int i = 1; i < n; ++i) renderer().render(s);
        return frame();
    }
    std::vector<float> of(std::string_view technique) { // of a first frame, with the same map and bias
        const ParameterSet& own = s.techniques.parameters();
        s.techniques.choose(technique);
        for (const char* id : {"map-size", "depth-bias", "slope-bias", "normal-offset"})
            s.techniques.parameters().at(id).set(own.at(id).value());
        renderer().reset();
        std::vector<float> psi = frame();
        s.techniques.choose("temporal");
        renderer().reset();
        return psi;
    }
    // The shadow buffer of the frame drawn last, as the picture shows it: ρ, n, depth, blocker.
    std::vector<glm::vec4> buffer() const {
        const Renderer::Pixels p = renderer().readPicture(*renderer().flow().find("temporal.shadow-buffer"));
        std::vector<glm::vec4> texels(p.values.size() / 4);
        for (size_t i = 0; i < texels.size(); ++i)
            texels[i] = {p.values[4 * i], p.values[4 * i + 1], p.values[4 * i + 2], p.values[4 * i + 3]};
        return texels;
    }
};

double rmse(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

double differing(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    size_t count = 0;
    for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
    return static_cast<double>(count) / static_cast<double>(a.size());
}

} // namespace

TEST_CASE("a view at rest holds the mean of the same maps, to the last bit, whatever the lookup and the overscan") {
    Bench b;
    b.samplesAlone();
    b.s.progressive = false;
    b.set("fit", "scene"); // not to the margin, too
    b.s.techniques.parametersOf("light-sampling").at("fit").setText("scene");
    for (const int n : {1, 3, 24}) {
        b.s.techniques.parametersOf("light-sampling").at("samples").set(n);
        const std::vector<float> mean = b.of("light-sampling");
        for (const char* lookup : {"nearest", "bilinear"}) {
            b.set("lookup", lookup);
            b.set("overscan", "0");
            renderer().reset();
            CAPTURE(n, lookup);
            CHECK((b.frames(n) == mean));
            b.set("format", "16f"); // as whole numbers
            renderer().reset();
            CHECK((b.frames(n) == mean));
            b.set("format", "32f");
            // The margin is drawn by another projection: a pixel in a thousand may fall to the other side of an edge.
            b.set("overscan", "50");
            renderer().reset();
            CHECK(differing(b.frames(n), mean) < 0.002);
        }
    }
}

TEST_CASE("several maps a frame are as many frames of one, while nothing changes") {
    Bench b;
    b.samplesAlone();
    const auto after = [&](const char* maps, int frames) {
        b.set("maps-at-rest", maps);
        renderer().reset();
        b.frames(frames);
        return b.buffer();
    };
    const std::vector<glm::vec4> ones = after("1", 25), fours = after("4", 7), twelves = after("12", 3);
    size_t others = 0, penumbra = 0, counted = 0;
    for (size_t i = 0; i < ones.size(); ++i) {
        REQUIRE(fours[i].y == ones[i].y); // n
        REQUIRE(twelves[i].y == ones[i].y);
        counted += ones[i].y == 25;
        penumbra += ones[i].x > 0 && ones[i].x < ones[i].y;
        others += std::abs(twelves[i].x - ones[i].x) > 1 || std::abs(fours[i].x - ones[i].x) > 1;
    }
    CHECK(counted > ones.size() / 3);
    CHECK(penumbra > ones.size() / 20);
    // Surfaces keep one offset for all maps of a frame, by which a test in a thousand may differ.
    CHECK(others < ones.size() / 1000);

    // Not while the camera moves, and after 256 points of the light no more than one.
    b.s.camera.eye.x += 0.05f;
    b.frame();
    CHECK_FALSE(renderer().flow().find("temporal-2.shadow-map").has_value());
    b.frame();
    CHECK(renderer().flow().find("temporal-12.shadow-map").has_value());
    renderer().reset();
    b.frames(1 + 22);
    float most = 0;
    for (const glm::vec4& texel : b.buffer()) most = std::max(most, texel.y);
    CHECK(most == 257);
    b.frame();
    CHECK_FALSE(renderer().flow().find("temporal-2.shadow-map").has_value());
}

TEST_CASE("a light without a size casts the hard shadow exactly") {
    Bench b;
    b.s.light.size = {0, 0};
    b.set("receiver-plane", "off");
    b.set("overscan", "0");
    b.set("slope-bias", "0.5");
    const std::vector<float> hard = b.of("hard");
    CHECK((b.frame() == hard));
    CHECK((b.frames(6) == hard));
}

TEST_CASE("the first frame is percentage-closer soft shadows from the light's centre") {
    Bench b;
    b.set("overscan", "0");
    b.set("neighbourhood", "off");
    for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
        b.s.light.shape = shape;
        if (shape == LightShape::Directional) b.s.light.size = {4, 0};
        const std::vector<float> estimate = b.of("pcss");
        // ψ · n_0 / n_0
        CHECK(rmse(b.frame(), estimate) < 1e-6);
    }
}

TEST_CASE("a surface seen anew is estimated as from the light's centre, whichever point the map is drawn from") {
    // With ε = 0 nothing keeps a history: every frame estimates.
    Bench b;
    b.set("neighbourhood", "off");
    b.set("epsilon", "0");
    b.set("filter-taps", "64");
    b.set("search-taps", "64");
    const std::vector<float> centre = b.frame();
    std::vector<float> mean(centre.size(), 0);
    constexpr int n = 16;
    for (int i = 0; i < n; ++i) {
        const std::vector<float> psi = b.frame();
        for (size_t k = 0; k < psi.size(); ++k) mean[k] += psi[k] / n;
        CHECK(rmse(psi, centre) < 0.08); // the maps see other sides of the boxes
    }
    CHECK(rmse(mean, centre) < 0.045);
    for (const glm::vec4 texel : b.buffer())
        if (texel.z != 0) CHECK(texel.y == 4);
}

TEST_CASE("it converges, with and without the filter, and the filter makes young shadows better") {
    Bench b;
    b.s.techniques.parametersOf("light-sampling").at("samples").set(512);
    b.s.progressive = false;
    const std::vector<float> truth = b.of("light-sampling");
    constexpr int frames[] = {1, 3, 7, 20, 256};
    const auto errors = [&] {
        renderer().reset();
        std::vector<double> all;
        int drawn = 0;
        for (const int n : frames) {
            const std::vector<float> psi = b.frames(n - drawn);
            drawn = n;
            all.push_back(rmse(psi, truth));
        }
        return all;
    };
    const std::vector<double> shown = errors();
    b.samplesAlone();
    const std::vector<double> alone = errors();
    CAPTURE(shown, alone);
    for (size_t i = 1; i < alone.size(); ++i) CHECK(alone[i] < alone[i - 1]);
    CHECK(shown[4] < 0.25 * shown[0]);
    for (const size_t young : {0, 1}) CHECK(shown[young] < 0.8 * alone[young]);
    CHECK(shown[4] < alone[4] + 0.002);
}

TEST_CASE("a poisoned texel of the history is dropped and does not spread") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (const char* lookup : {"nearest", "bilinear"})
        for (const glm::vec4 poison : {glm::vec4(nan), glm::vec4(nan, 5, 0, 0), glm::vec4(2, nan, 0, 0),
                                       glm::vec4(2, 5, 0, nan), glm::vec4(infinity), glm::vec4(-infinity)}) {
            Bench b;
            b.set("lookup", lookup);
            b.set("overscan", "0");
            b.frames(5);
            const Image image = *renderer().flow().find("temporal.shadow-buffer");
            const int x = 30, y = 20;
            const size_t at = static_cast<size_t>(47 - y) * 64 + x;
            const glm::vec4 healthy = b.buffer()[at];
            glm::vec4 texel = poison;
            if (texel.z == 0) texel.z = healthy.z; // the rest is as it was
            glTextureSubImage2D(renderer().runner().texture(renderer().flow(), image).name(), 0, x, y, 1, 1, GL_RGBA,
                                GL_FLOAT, &texel);
            for (const float psi : b.frame()) REQUIRE((psi >= 0 && psi <= 1));
            const std::vector<glm::vec4> after = b.buffer();
            for (size_t i = 0; i < after.size(); ++i) {
                for (int c = 0; c < 4; ++c) REQUIRE(std::isfinite(after[i][c]));
                if (i != at && after[i].z != 0) REQUIRE(after[i].y == 4 + 5); // the start counts for 4
            }
            CHECK(after[at].y == (std::isnan(poison.w) && poison.x == 2 ? 5 + 1 : 1)); // a blocker alone costs nothing
        }
}

TEST_CASE("what comes into view has a history if there is overscan") {
    const auto edgeCounts = [](const char* overscan) {
        Bench b(SceneBuilder().floor(30).build());
        b.set("overscan", overscan);
        for (int i = 0; i < 12; ++i) {
            b.s.camera.eye.x += 0.07f, b.s.camera.target.x += 0.07f;
            b.s.camera.eye.z -= 0.07f, b.s.camera.target.z -= 0.07f; // to the right, a pixel and a bit
            b.frame();
        }
        float least = 1e9f;
        const std::vector<glm::vec4> texels = b.buffer();
        for (int y = 24; y < 48; ++y) least = std::min(least, texels[static_cast<size_t>(y) * 64 + 63].y);
        return least;
    };
    CHECK(edgeCounts("0") == 4); // as new
    CHECK(edgeCounts("10") > 5);
}

TEST_CASE("a camera that pans keeps the histories of what stays in view") {
    for (const char* lookup : {"nearest", "bilinear"}) {
        Bench b(SceneBuilder().floor(30).build());
        b.set("lookup", lookup);
        for (int i = 0; i < 20; ++i) b.s.camera.eye.y += 0.004f, b.frame();
        int kept = 0, surfaces = 0;
        for (const glm::vec4 texel : b.buffer()) surfaces += texel.z != 0, kept += texel.y > 20;
        CAPTURE(lookup);
        CHECK(kept > 0.95 * surfaces);
    }
}

TEST_CASE("things that move keep their history, and the shadows of things that move are marked") {
    Bench b(wavingScene());
    b.s.size = {96, 72};
    const auto run = [&](const char* rule) {
        b.set("moving", rule);
        renderer().reset();
        b.s.time = 0.1;
        b.frames(3);
        for (int i = 0; i < 4; ++i) b.s.time += 0.05, b.frame();
        return b.buffer();
    };
    const auto tags = [](const std::vector<glm::vec4>& texels) {
        return std::count_if(texels.begin(), texels.end(), [](glm::vec4 t) { return t.z < 0; });
    };
    CHECK(tags(run("ignore")) == 0);
    const std::vector<glm::vec4> before = run("disocclusion");
    CHECK(tags(before) > 20);
    for (const glm::vec4 texel : before)
        if (texel.z < 0) CHECK(texel.y == 4); // estimated anew
    b.frame();                                // at rest
    CHECK(tags(b.buffer()) == 0);

    CHECK(tags(run("decrement")) > tags(before)); // those that the shadow has left, too
    b.frames(4);
    CHECK(tags(b.buffer()) == 0);

    // Most of the moving board was found in the frame before.
    (void)run("ignore");
    const Renderer::Pixels motion = renderer().readPicture(*renderer().flow().find("scene.motion"));
    const std::vector<glm::vec4> after = b.buffer();
    int moved = 0, kept = 0;
    for (size_t i = 0; i < after.size(); ++i) {
        const float* m = &motion.values[i * static_cast<size_t>(motion.channels)];
        if (std::hypot(m[0], m[1]) < 0.1f || after[i].z == 0) continue;
        ++moved;
        kept += after[i].y > 4;
    }
    CAPTURE(moved, kept);
    CHECK(moved > 30);
    CHECK(kept > 0.8 * moved);
}

TEST_CASE("where something moves, the shadow is no worse than an estimate, and follows when it has left") {
    Bench b(wavingScene());
    b.s.size = {96, 72};
    b.set("radius-scale", "0.5"); // filtered well, so that what is left is not noise
    b.s.techniques.parametersOf("light-sampling").at("samples").set(256);
    b.s.techniques.parametersOf("pcss").at("rotate").set(1);
    const auto errors = [&](const char* rule, const char* central) {
        b.set("moving", rule), b.set("central-map", central);
        renderer().reset();
        b.s.time = 0.1;
        b.frames(8);
        std::vector<float> last;
        for (int i = 0; i < 8; ++i) b.s.time += 0.02, last = b.frame();
        b.s.progressive = false;
        const std::vector<float> truth = b.of("light-sampling"), estimate = b.of("pcss");
        b.s.progressive = true;
        return std::pair(rmse(last, truth), rmse(estimate, truth));
    };
    const auto [region, estimate] = errors("region", "on");
    const double jumping = errors("region", "off").first, paper = errors("disocclusion", "off").first;
    CAPTURE(region, estimate, jumping, paper);
    CHECK(region < 1.15 * estimate);
    CHECK(region < jumping);
    CHECK(region < 0.8 * paper);
}

TEST_CASE("the filter asks the less the less is seen of a shadow") {
    Bench b;
    b.s.display.show = Show::Lit;
    const auto share = [&](const char* guided, float ambient) { // of the pixels that are filtered
        b.set("guided", guided);
        b.s.display.ambient = ambient;
        renderer().reset();
        b.frames(6);
        const std::vector<float> with = renderer().read(renderer().shadow()).values;
        b.set("neighbourhood", "off");
        renderer().reset();
        b.frames(6);
        const std::vector<float> without = renderer().read(renderer().shadow()).values;
        b.set("neighbourhood", "poisson");
        return differing(with, without);
    };
    const double all = share("0", 0.2f);
    CHECK(all > 0.05);
    CHECK(share("0", 50) == all); // what is seen does not count
    CHECK(share("1", 50) == 0);   // nothing of the light is seen
    CHECK(share("0.5", 0.2f) <= all);
}

TEST_CASE("a light that moves leaves as many samples as it is told, and none of a history where that is 0") {
    for (const char* memory : {"0", "6"}) {
        Bench b;
        b.set("light-memory", memory);
        b.frames(12);
        b.s.light.position.x += 0.05f;
        b.frame();
        const float expected = std::string_view(memory) == "0" ? 4 : 7;
        for (const glm::vec4 texel : b.buffer())
            if (texel.z != 0) REQUIRE(texel.y == Approx(expected));
    }
}

TEST_CASE("changing what is shown keeps the history, changing what is kept does not; and it ends at the limit") {
    Bench b;
    const auto samples = [&] { return b.buffer()[47 * 64 + 32].y; };
    b.frames(5);
    CHECK(samples() == 8);
    b.set("taps", "8"), b.set("s-max", "0.3"), b.set("neighbourhood", "box");
    b.frame();
    CHECK(samples() == 9);
    b.set("depth-bias", "1e-4");
    b.frame();
    CHECK(samples() == 4);
    b.s.size = {80, 50}; // while it runs
    for (const float psi : b.frame()) REQUIRE((psi >= 0 && psi <= 1));
    b.set("most-samples", "12");
    b.frames(30);
    CHECK(b.buffer()[40].y <= 12);
    CHECK_FALSE(renderer().flow().living());
    b.s.light.position.x += 0.1f;
    b.frame();
}

// Minutes on a software renderer: test-techniques "[long]"
TEST_CASE("100,000 frames do not drift from the mean of the same maps", "[.][long]") {
    Bench b;
    b.s.size = {8, 6};
    b.samplesAlone();
    b.set("map-size", "64");
    b.set("overscan", "0");
    b.frames(100000);
    const std::vector<glm::vec4> last = b.buffer();
    b.s.progressive = false;
    b.s.techniques.parametersOf("light-sampling").at("samples").set(4096);
    const std::vector<float> mean = b.of("light-sampling");
    for (size_t i = 0; i < mean.size(); ++i) {
        if (last[i].z == 0) continue;
        CHECK(last[i].y == 100000);
        CHECK(last[i].x == std::round(last[i].x)); // whole numbers still
        CHECK(last[i].x / last[i].y == Approx(mean[i]).margin(3 * std::sqrt(0.25 / 4096)));
    }
}

TEST_CASE(
    "in a pan the columns that have just come into view are hardly worse than those beside them, thanks to overscan") {
    // Under slats, so that penumbrae are everywhere, straight down: a shift of the eye is one of the picture.
    SceneBuilder builder;
    builder.floor(4);
    for (float x = -3; x < 3; x += 0.4f) builder.box({x, 1, -2}, {x + 0.15f, 1.02f, 2});
    Bench b(builder.build());
    b.s.size = {640, 24};
    const float pixel = 0.006f; // on the floor [m]
    const float fovY = glm::degrees(2 * std::atan(12 * pixel / 0.9f));
    const auto at = [&](int frame) {
        const float x = pixel * static_cast<float>(frame);
        return Camera{{x, 0.9f, 0}, {x, 0, 0}, {0, 0, -1}, fovY};
    };
    constexpr int frames[] = {30, 37, 44, 51};
    std::vector<std::vector<float>> truths;
    for (const int frame : frames) {
        b.s.camera = at(frame);
        b.s.techniques.parametersOf("light-sampling").at("samples").set(256);
        truths.push_back(b.of("light-sampling"));
    }
    // RMSE of the eight columns at the edge, as a multiple of that of the eight beside them.
    const auto outerToInner = [&](const char* overscan) {
        b.set("overscan", overscan);
        renderer().reset();
        double outer = 0, inner = 0;
        for (int frame = 0, k = 0; k < 4; ++frame) {
            b.s.camera = at(frame);
            const std::vector<float> psi = b.frame();
            if (frame != frames[k]) continue;
            for (size_t i = 0; i < psi.size(); ++i) {
                const size_t fromEdge = 639 - i % 640;
                const double e = psi[i] - truths[size_t(k)][i];
                if (fromEdge < 16) (fromEdge < 8 ? outer : inner) += e * e;
            }
            ++k;
        }
        INFO(overscan << " %: " << std::sqrt(outer) << " against " << std::sqrt(inner));
        CHECK(inner > 0);
        return std::sqrt(outer / inner);
    };
    CHECK(outerToInner("5") < 1.5);
    b.samplesAlone(); // the estimate and the filter help the first frames as well
    CHECK(outerToInner("5") < 1.5);
    CHECK(outerToInner("0") > 1.5);
}

TEST_CASE(
    "at 840x630 the two shadow buffers of half floats take 8.5 MB, and the paper keeps nothing else of that size") {
    Bench b;
    b.s.size = {800, 600};
    b.set("format", "16f");
    renderer().render(b.s);
    const Flow& flow = renderer().flow();
    uint64_t kept = 0;
    for (const Flow::PastNode& past : flow.pasts()) {
        CHECK(flow.label(past.label) == "temporal.shadow-buffer");
        CHECK(past.spec.extent == Extent{840, 630});
        kept += 2 * past.spec.bytes();
    }
    CHECK(kept == 8467200);
}
