// SPDX-License-Identifier: MIT
// Fractional-disk soft shadows: their disk, their pre-processing, their tests.
#include "app/preset.h"
#include "renderer/measure/errors.h"
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
        for (const char* id : {"map-size", "faces", "fit", "depth-bias", "slope-bias", "normal-offset"})
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
    b.set("map-size", "256");
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
    b.set("map-size", "512");
    b.set("texels-per-sample", "0.05"); // 64 samples wherever it filters
    for (const char* distance : {"fragment", "axial"})
        for (const char* preparation : {"flood", "separable", "none-corrected"}) {
            CAPTURE(distance, preparation);
            b.set("distance", distance);
            b.set("pre-processing", preparation);
            b.set("noise", "constants");
            CHECK(profileError(b).meanAbsolute < 0.02);
            if (std::string_view(preparation) == "none-corrected") continue; // its search is left to chance, too
            b.set("noise", "random-start");
            CHECK(profileError(b).meanAbsolute < 0.04);
        }
}

namespace {

struct Prepared {
    int size;
    std::vector<glm::vec3> edges, texels; // R, G, B of the first pass and of the last
};

Prepared prepare(Bench& b, const char* how, const char* radius) {
    b.set("pre-processing", how);
    b.set("max-radius", radius);
    b.psi();
    const auto read = [](const char* name) {
        const Renderer::Pixels p = Bench::image(name);
        std::vector<glm::vec3> texels(p.values.size() / 4);
        for (size_t i = 0; i < texels.size(); ++i)
            texels[i] = {p.values[4 * i], p.values[4 * i + 1], p.values[4 * i + 2]};
        return texels;
    };
    return {Bench::image("prepared").width, read("edges"), read("prepared")};
}

// As the longest side of the offset (Chebyshev), or its length.
glm::vec3 bruteForce(const Prepared& p, int x, int y, int radius, bool euclid) {
    const auto at = [&](int u, int v) { return p.edges[static_cast<size_t>(v * p.size + u)]; };
    float nearest = 1e9f, depth = 1, least = 1;
    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, p.size - 1); ++v)
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, p.size - 1); ++u) {
            if (at(u, v).z == 0) continue;
            const auto dx = static_cast<float>(u - x), dy = static_cast<float>(v - y);
            const float d = euclid ? std::hypot(dx, dy) : std::max(std::abs(dx), std::abs(dy));
            if (d < nearest) nearest = d, depth = at(u, v).y;
            least = std::min(least, at(u, v).y);
        }
    const float n = static_cast<float>(radius);
    return {euclid ? depth : least, nearest, nearest <= n ? n + 1 - nearest : 0};
}

} // namespace

TEST_CASE("pre-processing is brute force: Chebyshev's distance and the least depth, or Euclid's nearest edge") {
    Bench b;
    b.set("map-size", "128");
    for (const char* radius : {"1", "2", "5", "12", "33"}) {
        const int n = std::stoi(radius);
        CAPTURE(n);
        const Prepared published = prepare(b, "published", radius), separable = prepare(b, "separable", radius);
        CHECK((published.texels == separable.texels));
        const Prepared flood = prepare(b, "flood", radius);
        int wrong = 0, edges = 0;
        double worst = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x) {
                const auto i = static_cast<size_t>(y * 128 + x);
                const glm::vec3 chebyshev = bruteForce(published, x, y, n, false);
                wrong += published.texels[i] != glm::vec3(published.edges[i].x, chebyshev.x, chebyshev.z);
                edges += published.edges[i].z > 0;
                const glm::vec3 euclid = bruteForce(flood, x, y, n, true);
                worst = std::max<double>(worst, std::abs(flood.texels[i].z - euclid.z));
                wrong += flood.texels[i].x != flood.edges[i].x || (flood.texels[i].y < 1) != (flood.texels[i].z > 0);
            }
        CHECK(edges > 100);
        CHECK(wrong == 0);
        CHECK(worst < 0.5); // of a texel
    }
}

TEST_CASE("pixels far from every boundary are not filtered, and their shadow is the hard one") {
    Bench b = halfPlane();
    const std::vector<float> psi = b.psi();
    const Renderer::Pixels regions = Bench::image("regions");
    const std::vector<float> hard = b.hard();
    int counted[5] = {}, wrong = 0;
    for (size_t i = 0; i < psi.size(); ++i) {
        const auto region = static_cast<int>(regions.values[2 * i]);
        const float samples = regions.values[2 * i + 1];
        REQUIRE((region >= 0 && region <= 4));
        ++counted[region];
        const bool penumbra = region == 2 || region == 3;
        wrong += (samples > 0) != penumbra;
        if (!penumbra) wrong += psi[i] != hard[i];
    }
    CHECK(wrong == 0);
    for (int region = 1; region <= 4; ++region) CHECK(counted[region] > 100);
    // ψ of what is filtered lies in between, but for the outskirts.
    int between = 0;
    for (size_t i = 0; i < psi.size(); ++i) between += regions.values[2 * i + 1] > 0 && psi[i] > 0 && psi[i] < 1;
    CHECK(between > 0.8 * (counted[2] + counted[3])); // a sample in 64 is a tenth of the radius at the rim
}

namespace {

Bench builtIn(std::string_view name) {
    Bench b;
    b.s.setScene(std::make_shared<const Scene>(importGltf(findScene(name))));
    b.s.size = {320, 180};
    return b;
}

} // namespace

TEST_CASE("the two-step test takes a thin slab's shadow off itself, and adds no error of another kind") {
    Bench b = builtIn("slanting-slab");
    b.s.size = {640, 360};
    b.psi();
    const Truth truth =
        traceTruth(readTruthInput(renderer(), b.s), {.leastSamples = 256, .mostSamples = 256, .threads = 2});
    const auto squares = [&](const char* how) { // of each kind, over all pixels
        b.set("two-step", how);
        const Errors errors = errorsOf(b.psi(), truth);
        std::array<double, errorKinds> sums = errors.share;
        for (double& sum : sums) sum *= errors.all.rmse * errors.all.rmse;
        return sums;
    };
    const auto off = squares("off"), outer = squares("outer"), everywhere = squares("everywhere");
    const auto falseShadow = static_cast<size_t>(ErrorKind::FalseShadow), leak = static_cast<size_t>(ErrorKind::Leak);
    CAPTURE(off, outer, everywhere);
    CHECK(off[falseShadow] > 1e-4);
    for (const auto& with : {outer, everywhere}) CHECK(with[falseShadow] < 0.2 * off[falseShadow]);
    for (size_t kind = 0; kind < errorKinds; ++kind)
        if (kind != falseShadow) CHECK(outer[kind] <= 1.1 * off[kind]);
    CHECK(everywhere[leak] > outer[leak]); // light behind what reaches down to the receiver
}

TEST_CASE("in the default scene fewer than half of the pixels are filtered") {
    Bench b = builtIn("courtyard");
    b.psi();
    const Renderer::Pixels regions = Bench::image("regions");
    int filtered = 0;
    for (size_t i = 1; i < regions.values.size(); i += 2) filtered += regions.values[i] > 0;
    CHECK(filtered > 0.1 * 320 * 180);
    CHECK(filtered < 0.5 * 320 * 180);
}

TEST_CASE("the published preset is what the paper says") {
    TechniqueShelf shelf;
    loadPreset(findPreset("fractional-disk/published"), shelf);
    const ParameterSet& set = shelf.parameters();
    for (const auto& [id, value] : std::initializer_list<std::pair<const char*, const char*>>{
             {"pre-processing", "published"}, // figure 5
             {"max-radius", "17"},            // Results: 17 passes of pre-processing
             {"texels-per-sample", "2"},      // figure 2
             {"max-samples", "50"},           // Results: 5 passes of 10 samples
             {"noise", "random-start"},       // Final rendering
             {"two-step", "everywhere"},      // every point in the disk
             {"object-ids", "false"},         // Brabec's answer, which it does without
             {"listing", "corrected"},        // its equations, not its slips
             {"distance", "vertex"},          // Shadow map generation
             {"faces", "back"},               // second depth
             {"samples-per-pixel", "0"},      // Optimizations: could
             {"accumulate", "false"},
             {"neighbourhood-filter", "false"},
             {"light-scale", "1"}})
        CHECK((std::string(id) + " " + set.at(id).text()) == (std::string(id) + " " + value));
}

TEST_CASE("with object numbers a thing throws no shadow on itself, and the same shadow as before on others") {
    SceneBuilder arch; // one thing: a plate on two legs, over its own base
    arch.box({-1, 0, -1}, {1, 0.1f, 1}).box({-0.6f, 1, -0.6f}, {0.6f, 1.1f, 0.6f});
    Bench one(arch.merged()), several(arch.build());
    for (Bench* b : {&one, &several}) b->set("map-size", "256"), b->set("faces", "both");
    const auto onTop = [](Bench& b, const char* numbers) {
        b.set("object-ids", numbers);
        const ShadowImage image = draw(b.s);
        double sum = 0;
        for (int y = 0; y < image.psi.height; ++y)
            for (int x = 0; x < image.psi.width; ++x) {
                const glm::vec3 p = image.positionWorld(x, y);
                const bool inside = std::abs(p.x) < 0.95f && std::abs(p.z) < 0.95f; // of the base's top
                if (image.surface(x, y) && inside && std::abs(p.y - 0.1f) < 1e-3f) sum += image.at(x, y);
            }
        return sum;
    };
    CHECK(onTop(one, "off") > 50);
    CHECK(onTop(one, "on") == 0);
    CHECK(onTop(several, "on") == Approx(onTop(several, "off")).epsilon(0.02));
    CHECK(driverMessages().empty());
}

TEST_CASE("noise falls with the number of samples, as 1/√n or faster") {
    Bench b = halfPlane();
    b.set("map-size", "512");
    b.set("texels-per-sample", "0.05");
    double before = 0;
    for (const char* samples : {"4", "16", "64"}) {
        b.set("max-samples", samples);
        const double rms = profileError(b).rms;
        CAPTURE(samples, rms, before);
        if (before > 0) CHECK(rms < before / 1.9); // a quarter of the variance, and a little for the map's texels
        before = rms;
    }
}

TEST_CASE("accumulated frames and the neighbourhood filter take the noise away") {
    Bench b = halfPlane();
    b.set("map-size", "512"); // whose texels are little beside the noise that is left
    b.set("max-samples", "8");
    const double one = profileError(b).rms;
    b.set("neighbourhood-filter", "on");
    const double filtered = profileError(b).rms;
    b.set("neighbourhood-filter", "off");
    b.set("accumulate", "on");
    const auto accumulated = [&](int frames) {
        renderer().reset();
        for (int i = 0; i < frames; ++i) renderer().render(b.s);
        const std::vector<float> psi = renderer().read(renderer().shadow()).values;
        b.set("accumulate", "off");
        const ShadowImage places = draw(b.s);
        b.set("accumulate", "on");
        double squares = 0;
        int pixels = 0;
        for (int y = 0; y < places.psi.height; ++y)
            for (int x = 0; x < places.psi.width; ++x) {
                if (!places.surface(x, y) || places.positionWorld(x, y).y > 1) continue;
                const double expected = closedForm(places.positionWorld(x, y).x);
                if (expected <= 0 || expected >= 1) continue;
                squares += std::pow(psi[places.index(x, y)] - expected, 2), ++pixels;
            }
        return std::sqrt(squares / pixels);
    };
    const double four = accumulated(4), many = accumulated(24);
    CAPTURE(one, filtered, four, many);
    CHECK(filtered < 0.5 * one);
    CHECK(four < 0.6 * one);
    CHECK(many < 0.25 * one);
    CHECK(accumulated(1) == Approx(one).epsilon(0.2));
}

TEST_CASE("the listing's slips are there to be seen") {
    Bench b = halfPlane();
    b.set("map-size", "512");
    const auto mean = [&](const char* listing) {
        b.set("listing", listing);
        return draw(b.s).meanOverSurface();
    };
    const double corrected = mean("corrected");
    // A sum that starts with a lit sample: too light. Samples on one side of the receiver: the penumbra moves.
    CHECK(mean("sum") < corrected - 1e-4);
    CHECK(std::abs(mean("noise") - corrected) > 0.01);
    // Wide penumbrae are cut off at n + 1 − q texels from the boundary.
    const auto filtered = [&](const char* listing, const char* scale) {
        b.set("listing", listing);
        b.set("light-scale", scale);
        b.psi();
        const Renderer::Pixels regions = Bench::image("regions");
        int count = 0;
        for (size_t i = 1; i < regions.values.size(); i += 2) count += regions.values[i] > 0;
        return count;
    };
    CHECK(filtered("corrected", "1") > 2 * filtered("corrected", "0.4"));
    CHECK(filtered("early-out", "1") < filtered("early-out", "0.4"));
    // The same everywhere: no early out.
    b.set("pre-processing", "published");
    b.set("map-size", "256");
    CHECK(filtered("distance", "0.2") > 1.5 * filtered("corrected", "0.2"));
}

TEST_CASE("radii and samples and ranges at their ends") {
    Bench b;
    b.set("map-size", "256");
    const auto sane = [&] {
        for (const float psi : b.psi()) REQUIRE((psi >= 0 && psi <= 1));
        CHECK(driverMessages().empty());
    };
    SECTION("a huge light") {
        b.s.light.size = {1e4f, 1e4f};
        sane();
    }
    SECTION("samples and their number") {
        for (const char* a : {"0.05", "64"})
            for (const char* samples : {"1", "256"})
                for (const char* noise : {"random-start", "interpolated", "one-dimensional", "constants"}) {
                    b.set("texels-per-sample", a), b.set("max-samples", samples), b.set("noise", noise);
                    sane();
                    const Renderer::Pixels regions = Bench::image("regions");
                    float most = 0;
                    for (size_t i = 1; i < regions.values.size(); i += 2) most = std::max(most, regions.values[i]);
                    CHECK(most >= 1);
                    CHECK(most <= std::stof(samples));
                }
    }
    SECTION("an occluder that touches the light") {
        b.s.scene = SceneBuilder().floor(3).box({-0.5f, 3.9f, -0.5f}, {0.5f, 4, 0.5f}).build();
        sane();
    }
    const auto onFloor = [&] {
        const ShadowImage image = draw(b.s);
        double sum = 0;
        for (int y = 0; y < image.psi.height; ++y)
            for (int x = 0; x < image.psi.width; ++x)
                if (image.surface(x, y) && image.positionWorld(x, y).y < 0.01f) sum += image.at(x, y);
        return sum;
    };
    SECTION("a light inside of the attenuation's start") {
        const double whole = onFloor();
        b.set("attenuation-start", "10"); // all is nearer than that, and stored as if it were there
        CHECK(onFloor() == 0);
        sane();
        b.set("attenuation-start", "3.4"); // the box that floats is nearer, and still casts
        CHECK(onFloor() > 0.1 * whole);
        sane();
    }
    SECTION("a receiver beyond the attenuation's end") {
        const double whole = onFloor();
        b.set("attenuation-end", "3.6"); // beyond the floating box, before the floor
        CHECK(onFloor() > 0.1 * whole);
        CHECK(onFloor() < whole + 1e-3);
        b.set("attenuation-end", "2"); // before everything
        CHECK(onFloor() == 0);
        sane();
    }
    SECTION("an empty map") {
        b.s.scene = SceneBuilder().floor(3).build(); // faces the light
        for (const char* how : {"flood", "separable", "published", "none", "none-corrected"}) {
            b.set("pre-processing", how);
            CAPTURE(how);
            CHECK(draw(b.s).meanOverSurface() == 0);
        }
    }
}

TEST_CASE(
    "interpolated distances of large triangles lie beyond the true ones, and along the axis there is no difference") {
    // The middle of a slab that is as wide as it is far: its corners are much farther from the light.
    Bench b(SceneBuilder().floor(3).box({-2, 2, -2}, {2, 2.1f, 2}).build());
    b.set("map-size", "64");
    const auto middle = [&](const char* distance) {
        b.set("distance", distance);
        b.psi();
        const Renderer::Pixels map = Bench::image("shadow-map");
        return map.values[static_cast<size_t>(32 * map.width + 32)];
    };
    CHECK(middle("vertex") > middle("fragment") + 0.05);
    b.psi();
    CHECK(driverMessages().empty());
}
