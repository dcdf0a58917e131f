// SPDX-License-Identifier: MIT
// Filterable shadow maps through the whole pipeline: map, filter and resolve on the GPU.
#include "renderer/shadow_map/moment_map.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// Two plates that meet at x = 0, at map depths 0.25 and 0.75, and a floor below either or, at less than 0.75, below the
// left one alone. A kernel at x = 0 holds half of each.
constexpr float span = 4, nearSlack = 1e-3f * span; // of the map's depth range, which has some slack at either end

float heightOf(double z) { return span + nearSlack - static_cast<float>(z) * (span + 2 * nearSlack); }

std::shared_ptr<const Scene> step(double z_f, float texel) {
    SceneBuilder builder;
    const auto plate = [&](double z, float x0, float x1, float halfZ) {
        const float y = heightOf(z);
        builder.quad({x0, y, halfZ}, {x1, y, halfZ}, {x1, y, -halfZ}, {x0, y, -halfZ});
    };
    plate(0.25, -2, 0, 2);
    plate(0.75, 0, 2, 2);
    plate(z_f, -2, z_f < 0.75 ? 0.2f * texel : 2.0f, 2);
    for (const float side : {-1.0f, 1.0f}) // hold the ends of the depth range
        for (const double z : {nearSlack / (span + 2 * nearSlack), (span + nearSlack) / (span + 2 * nearSlack)})
            plate(z, side * 1.95f - 0.05f, side * 1.95f + 0.05f, 0.05f);
    return builder.build();
}

// ψ at x = 0 on the floor.
float psiAtStep(std::string_view technique, double z_f, const std::vector<std::string>& settings) {
    constexpr int mapSize = 128;
    Session s = session(step(z_f, 4.0f / mapSize), technique);
    s.light = {.shape = LightShape::Directional, .position = {0, 10, 0}, .target = {0, 0, 0}, .size = {0, 0}};
    const float y = heightOf(z_f);
    s.camera = {.eye = {0, y + 0.1f, 1}, .target = {0, y, 0}, .fovY = 20};
    s.size = {5, 41};
    for (const std::string& setting : settings) s.techniques.assign(setting);
    s.techniques.assign("map-size=" + std::to_string(mapSize));
    for (const char* bias : {"depth-bias=0", "slope-bias=0", "normal-offset=0"}) s.techniques.assign(bias);
    const ShadowImage image = draw(s);
    REQUIRE(image.surface(2, 20));
    REQUIRE(std::abs(image.positionWorld(2, 20).x) < 1e-5f);
    REQUIRE(std::abs(image.positionWorld(2, 20).y - y) < 1e-3f);
    return image.at(2, 20);
}

struct Golden {
    const char* technique;
    std::vector<std::string> settings;
    std::vector<std::pair<double, double>> psi; // z_f, ψ
    double margin;
};

} // namespace

TEST_CASE("two surfaces give every filterable map its golden ψ") {
    const std::vector<std::string> float32{"format=32f"}, halves{"format=unorm16-optimised"};
    const Golden cases[] = {
        {"pcf", {"shape=gaussian", "kernel=9"}, {{0.5, 0.5}, {0.6, 0.5}, {0.8, 1}, {0.9, 1}}, 1e-5},
        {"vsm",
         {"format=32f", "minimum-variance=0"},
         {{0.5, 0}, {0.6, 0.01 / 0.0725}, {0.8, 1 - 0.409836065574}, {0.9, 1 - 0.280898876404}},
         1e-4},
        {"vsm",
         {"format=unorm16-optimised", "minimum-variance=0"},
         {{0.8, 1 - 0.409852058635}, {0.9, 1 - 0.280909664238}},
         1e-4},
        {"vsm",
         {"format=unorm16", "depth-range=signed", "minimum-variance=0"},
         {{0.8, 1 - 0.409836065574}, {0.9, 1 - 0.280898876404}},
         2e-4},
        {"vsm",
         {"format=32f", "minimum-variance=0", "bleeding-reduction=0.2"},
         {{0.8, 1 - 0.262295081967}, {0.9, 1 - 0.101123595506}},
         1e-4},
        {"vsm", {"format=32f", "minimum-variance=0", "bleeding-reduction=0.5"}, {{0.8, 1}, {0.9, 1}}, 1e-4},
        {"esm", {"fallback=false"}, {{0.5, 0}, {0.8, 1 - 9.15781944437e-3}, {0.9, 1 - 3.07210617666e-6}}, 2e-4},
        {"esm", {"fallback=false", "exponent=40"}, {{0.8, 1 - 0.0676676417578}}, 2e-4},
        {"esm", {"fallback=false", "exponent=10"}, {{0.8, 1 - 0.305308715576}, {0.9, 1 - 0.112316799671}}, 2e-4},
        {"esm", {"fallback=false", "format=16f", "exponent=10"}, {{0.8, 1 - 0.305308715576}}, 2e-3},
        {"esm", {"fallback=true"}, {{0.5, 0.5}, {0.6, 0.5}}, 1e-5},
        {"evsm", {"positive-exponent=5.54", "components=2"}, {{0.5, 0}, {0.8, 1 - 0.139249248083}}, 1e-3},
        {"evsm",
         {"positive-exponent=5.54", "negative-exponent=5.54"},
         {{0.5, 1 - 0.562416923019}, {0.8, 1 - 0.139249248083}, {0.9, 1 - 0.0107934357424}},
         1e-3},
        {"evsm",
         {"positive-exponent=40", "negative-exponent=40"},
         {{0.5, 1 - 0.500000002061}, {0.8, 1}, {0.9, 1 - 1.59998423088e-5}},
         1e-4},
        {"msm-hamburger",
         {"format=32f", "depth-range=unsigned"},
         {{0.5, 0.499991000288}, {0.6, 0.5}, {0.9, 0.999992603703}},
         2e-4},
        {"msm-hamburger",
         {"format=32f", "moment-bias=3e-4", "depth-range=unsigned"},
         {{0.5, 0.498656450971}, {0.9, 0.998893953966}},
         2e-4},
        {"msm-hamburger",
         {"format=unorm16-optimised", "depth-range=unsigned"},
         {{0.5, 0.499865064771}, {0.9, 0.999889087589}},
         2e-3},
        {"msm-hamburger", {"format=32f", "depth-range=signed"}, {{0.5, 0.499999400001}, {0.9, 0.999999506904}}, 1e-4},
        {"msm-hamburger",
         {"format=unorm16-optimised", "depth-range=signed", "moment-bias=6e-5"},
         {{0.5, 0.499819382169}, {0.9, 0.999851543893}},
         2e-3},
        {"msm-hausdorff", {"format=32f"}, {{0.5, 0.499991000288}, {0.6, 0.499994489961}, {0.95, 0.99999641267}}, 2e-4},
        {"msm-hausdorff", {"format=unorm16-optimised"}, {{0.6, 0.499917383964}, {0.95, 0.999946198978}}, 2e-3},
        {"msm-trigonometric",
         {"format=32f", "near-margin=0", "moment-bias=1e-4"},
         {{0.6, 0.499975001}, {0.9, 0.999923615}},
         1e-4},
        {"msm-trigonometric",
         {"format=32f", "near-margin=0", "moment-bias=1e-5"},
         {{0.6, 0.499997500}, {0.9, 0.999992361}},
         1e-4},
        {"msm-six", {"moment-bias=1e-5"}, {{0.5, 0.4999850008}, {0.6, 0.499991278162}, {0.9, 0.999993027508}}, 1e-4},
        {"convolution",
         {"terms=4", "attenuation=0", "range-margin=0", "reconstruction=series", "format=32f"},
         {{0.5, 0.5}, {0.8, 1 - 0.0722792485332}, {0.9, 1}}, // there the series is below 0
         1e-4},
        {"convolution",
         {"attenuation=0", "range-margin=0", "reconstruction=series", "format=snorm16"},
         {{0.8, 1 - 5.7689561586e-3}, {0.9, 1}},
         1e-3},
        {"convolution",
         {"attenuation=0", "range-margin=0", "reconstruction=doubled", "format=32f"},
         {{0.5, 0}, {0.8, 1 - 0.0115379123172}, {0.9, 1}},
         1e-3},
        {"convolution",
         {"attenuation=0", "range-margin=0", "reconstruction=bound", "format=32f"},
         {{0.5, 1 - 0.565235641873}, {0.8, 1 - 0.0877635877825}, {0.9, 1 - 0.100207373646}},
         1e-3},
        {"lvsm", {"layers=1", "minimum-variance=0", "overlap=0", "format=32f"}, {{0.9, 1 - 0.280898876404}}, 1e-4},
        {"lvsm", {"layers=2", "minimum-variance=0", "overlap=0", "format=32f"}, {{0.9, 1 - 0.171232876712}}, 1e-4},
        {"lvsm", {"layers=4", "minimum-variance=0", "overlap=0"}, {{0.9, 1}}, 1e-3},
    };
    for (const Golden& golden : cases)
        for (const auto& [z_f, psi] : golden.psi) {
            std::string settings;
            for (const std::string& setting : golden.settings) settings += setting + " ";
            CAPTURE(golden.technique, settings, z_f);
            CHECK(psiAtStep(golden.technique, z_f, golden.settings) == Approx(psi).margin(golden.margin));
        }
    CHECK(driverMessages().empty());
}

TEST_CASE("a summed-area table is exact to the last of its 32 bits") {
    Session s = session(step(0.9, 4.0f / 128), "msm-soft");
    for (const char* setting : {"map-size=200", "widest-window=64", "cells=1"}) s.techniques.assign(setting);
    (void)draw(s);
    const Flow& flow = renderer().flow();
    constexpr size_t side = 200;
    std::vector<uint32_t> sums(4 * side * side);
    const Texture& table = renderer().runner().texture(flow, *flow.find("msm-soft.summed-area"));
    REQUIRE(table.extent() == Extent{side, side});
    glGetTextureImage(table.name(), 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, static_cast<GLsizei>(4 * sums.size()),
                      sums.data());
    const Renderer::Pixels depth = renderer().read(*flow.find("msm-soft.shadow-map"));
    const auto sum = [&](size_t x, size_t y, size_t k) {
        return x == 0 || y == 0 ? 0 : sums[4 * ((y - 1) * side + x - 1) + k];
    };
    // Each texel again from four sums; the whole sum wraps around many times.
    const double levels = 4294967295.0 / (65 * 65);
    uint64_t all = 0;
    double worst = 0;
    for (size_t y = 0; y < side; ++y)
        for (size_t x = 0; x < side; ++x) {
            const double z = 2 * double(depth.values[(side - 1 - y) * side + x]) - 1;
            const double root3 = std::sqrt(3.0);
            const double stored[] = {0.5 + 1.5 * z - 2 * z * z * z, 4 * (z * z - z * z * z * z),
                                     0.5 + root3 / 2 * z - 2 * root3 / 9 * z * z * z, 0.5 * (z * z + z * z * z * z)};
            for (size_t k = 0; k < 4; ++k) {
                const uint32_t texel = sum(x + 1, y + 1, k) - sum(x, y + 1, k) - sum(x + 1, y, k) + sum(x, y, k);
                worst = std::max(worst, std::abs(texel - std::clamp(stored[k], 0.0, 1.0) * std::floor(levels)));
                all += k == 3 ? texel : 0;
            }
        }
    CHECK(worst < 1.5);
    CHECK(all > uint64_t(4) << 32);
    CHECK(driverMessages().empty());
}

TEST_CASE("a mip chain and several depths a texel change nothing where a map is flat, and average where it is not") {
    const auto psi = [](std::string_view technique, std::vector<std::string> settings) {
        settings.push_back("format=32f");
        return psiAtStep(technique, 0.9, settings);
    };
    for (const char* technique : {"vsm", "msm-hausdorff"}) {
        CAPTURE(technique);
        const float plain = psi(technique, {});
        CHECK(psi(technique, {"samples=4"}) == Approx(plain).margin(0.02));
        CHECK(psi(technique, {"mipmaps=true"}) == Approx(plain).margin(0.02));
        CHECK(psi(technique, {"mipmaps=true", "anisotropy=16"}) == Approx(plain).margin(0.02));
    }
}

TEST_CASE("a probed pixel's heavy curve is the technique itself: it meets the fragment at the picture's ψ") {
    // A corner of the box's shadow, where kernels hold the box and the floor.
    for (const Card* card : catalogue()) {
        Session s = quickSession(SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).build(), card->id);
        s.light.position = {1.5f, 3, 1};
        const std::span<const ProbePlot> plots = s.techniques.technique().probePlots();
        const auto curves = std::find_if(plots.begin(), plots.end(),
                                         [](const ProbePlot& p) { return p.kind == ProbePlot::Kind::Curves; });
        if (curves == plots.end()) continue;
        CAPTURE(card->id);
        const auto heavy = std::find_if(curves->series.begin(), curves->series.end(),
                                        [](const ProbeSeries& series) { return series.mark == ProbeMark::Heavy; });
        REQUIRE(heavy != curves->series.end());
        // Of a series: its channel in every column.
        const auto valuesOf = [&](std::string_view channel) {
            const size_t dot = channel.find('.');
            const Flow& flow = renderer().flow();
            const Image image = *flow.find(std::string(card->id) + "." + std::string(channel.substr(0, dot)));
            const std::span<const Channel> channels = flow.spec(image).channels;
            size_t k = 0;
            while (channels[k].name != channel.substr(dot + 1)) ++k;
            const Renderer::Pixels pixels = renderer().read(image);
            std::vector<float> values;
            for (size_t i = k; i < pixels.values.size(); i += static_cast<size_t>(pixels.channels))
                values.push_back(pixels.values[i]);
            return values;
        };
        // With the usual values, and with others that change the curve.
        const std::pair<const char*, const char*> others[] = {{"msm-hamburger", "moment-bias=1e-2"},
                                                              {"evsm", "positive-exponent=2"},
                                                              {"lvsm", "layers=1"},
                                                              {"convolution", "terms=2"},
                                                              {"esm", "fallback=false"},
                                                              {"msm-soft", "cells=1"}};
        std::vector<float> usual;
        for (const char* setting : {"", std::find_if(std::begin(others), std::end(others) - 1, [&](const auto& other) {
                                            return other.first == card->id;
                                        })->second}) {
            if (*setting != 0) {
                if (!s.techniques.parameters().find(
                        std::string_view(setting).substr(0, std::string_view(setting).find('='))))
                    continue;
                s.techniques.assign(setting);
            }
            const ShadowImage plain = draw(s);
            // The pixel that is nearest to being half in shadow.
            glm::ivec2 half(0);
            for (int y = 0; y < plain.psi.height; ++y)
                for (int x = 0; x < plain.psi.width; ++x)
                    if (std::abs(plain.at(x, y) - 0.5f) < std::abs(plain.at(half.x, half.y) - 0.5f)) half = {x, y};
            const float shown = plain.at(half.x, half.y);
            CAPTURE(setting, half.x, half.y, shown);
            CHECK(std::abs(shown - 0.5f) < 0.45f);
            renderer().inspect({.probe = glm::ivec2(half.x, plain.psi.height - 1 - half.y)});
            (void)draw(s);
            renderer().inspect({});
            const std::vector<float> z = valuesOf(curves->series[0].channel), psi = valuesOf(heavy->channel);
            const auto own = std::find(z.begin(), z.end(), valuesOf(curves->series[2].channel)[0]);
            REQUIRE(own != z.end());
            CHECK(psi[static_cast<size_t>(own - z.begin())] == Approx(shown).margin(1e-4));
            CHECK(psi.front() < 0.01f); // in front of all
            if (*setting != 0) CHECK(psi != usual);
            usual = psi;
        }
    }
    CHECK(driverMessages().empty());
}

TEST_CASE("an exponent at its format's limit gives a finite ψ, and one beyond is refused with the limit") {
    struct Limit {
        const char *technique, *format, *parameter;
        double largest, beyond;
    };
    for (const Limit& limit :
         {Limit{"esm", "32f", "exponent", 174, 0}, Limit{"esm", "16f", "exponent", 19.4, 20},
          Limit{"evsm", "32f", "positive-exponent", 44, 0}, Limit{"evsm", "16f", "positive-exponent", 5.54, 6},
          Limit{"evsm", "16f", "negative-exponent", 5.54, 6}}) {
        CAPTURE(limit.technique, limit.format, limit.parameter);
        Session s = quickSession(SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).build(), limit.technique);
        ParameterSet& set = s.techniques.parameters();
        set.at("format").setText(limit.format);
        set.at(limit.parameter).set(limit.largest);
        const std::vector<float> psi = draw(s).psi.values;
        CHECK(std::all_of(psi.begin(), psi.end(), [](float v) { return v >= 0 && v <= 1; }));
        const Image moments = *renderer().flow().find(std::string(limit.technique) + ".moments");
        const std::vector<float> stored = renderer().read(moments).values;
        CHECK(std::all_of(stored.begin(), stored.end(), [](float v) { return std::isfinite(v); }));
        if (limit.beyond == 0) {
            CHECK_THROWS_WITH(set.at(limit.parameter).set(limit.largest + 1),
                              contains(fmt::format("{:g}", limit.largest)));
            continue;
        }
        set.at(limit.parameter).set(limit.beyond);
        CHECK_THROWS_WITH(renderer().render(s),
                          contains(limit.parameter) && contains(fmt::format("{:g}", limit.largest)));
    }
}

TEST_CASE("what lies outside of a filtered map is lit, whatever the kernel") {
    const auto scene =
        std::make_shared<Scene>(*SceneBuilder().floor(3).box({-0.4f, 0, -0.4f}, {0.4f, 1, 0.4f}).build());
    for (size_t m = 0; m < 2; ++m) scene->meshes[m].primitives[0].shadesItself = false; // the floor: no texels for it
    for (const Card* card : catalogue()) {
        Session s = quickSession(scene, card->id);
        Parameter* const kernel = s.techniques.parameters().find("kernel");
        if (!kernel || s.techniques.technique().probePlots().empty()) continue;
        constexpr int size = 64; // texels along a side
        s.techniques.parameters().at("map-size").set(size);
        s.light = {.shape = LightShape::Directional, .position = {0, 9, 0}, .target = {0, 0, 0}, .size = {0, 0}};
        for (const double width : {1.0, 31.0}) {
            kernel->set(width);
            CAPTURE(card->id, width);
            const ShadowImage image = draw(s);
            const LightViewBlock map = lightView(s.light, renderer().state().occluders(), {.size = size});
            // Filtered, casters reach half a kernel beyond the map.
            const float beyond = map.window.z * (1 + (float(width) + 3) / size);
            int outside = 0, wrong = 0;
            for (int y = 0; y < image.psi.height; ++y)
                for (int x = 0; x < image.psi.width; ++x) {
                    if (!image.surface(x, y)) continue;
                    const glm::vec4 p = map.lightFromWorld * glm::vec4(image.positionWorld(x, y), 1);
                    if (std::abs(p.x - map.window.x) < beyond && std::abs(p.y - map.window.y) < beyond) continue;
                    ++outside;
                    wrong += image.at(x, y) != 0;
                }
            CHECK(outside > 100);
            CHECK(wrong == 0);
        }
    }
    CHECK(driverMessages().empty());
}

TEST_CASE("holes of masked casters are holes in every filtered map") {
    // A plate above the floor, of which the right half is cut out.
    auto scene =
        std::make_shared<Scene>(*SceneBuilder().floor(3).quad({-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}).build());
    scene->textures.push_back({.name = "half",
                               .width = 2,
                               .rgba = {255, 255, 255, 255, 255, 255, 255, 0},
                               .wrapU = Wrap::ClampToEdge,
                               .magnifyNearest = true});
    scene->materials.push_back({.texture = 0, .masked = true, .doubleSided = true});
    for (size_t m = 2; m < 4; ++m) {
        Primitive& p = scene->meshes[m].primitives[0];
        p.material = 1;
        for (uint32_t v = p.firstVertex; v < p.firstVertex + 3; ++v)
            scene->uvs[v] = {0.5f * scene->positions[v].x + 0.5f, 0.5f};
    }
    for (const Card* card : catalogue()) {
        Session s = quickSession(scene, card->id);
        const std::span<const ProbePlot> plots = s.techniques.technique().probePlots();
        if (plots.empty() || plots[0].kind != ProbePlot::Kind::Curves) continue;
        s.light = {.shape = LightShape::Directional, .position = {0, 9, 0}, .target = {0, 0, 0}, .size = {0.1f, 0}};
        s.camera = {.eye = {0, 0.6f, 2.5f}, .target = {0, 0, 0}, .fovY = 50}; // below the plate
        CAPTURE(card->id);
        const ShadowImage image = draw(s);
        int dark = 0, lit = 0, wrong = 0;
        for (int y = 0; y < image.psi.height; ++y)
            for (int x = 0; x < image.psi.width; ++x) {
                if (!image.surface(x, y)) continue;
                const glm::vec3 p = image.positionWorld(x, y);
                if (p.y > 0.5f || std::abs(p.z) > 0.6f || std::abs(std::abs(p.x) - 0.5f) > 0.25f) continue;
                ++(p.x < 0 ? dark : lit);
                wrong += std::abs(image.at(x, y) - (p.x < 0 ? 1.0f : 0.0f)) > 0.03f;
            }
        CHECK(dark > 50);
        CHECK(lit > 50);
        CHECK(wrong == 0);
    }
    CHECK(driverMessages().empty());
}
