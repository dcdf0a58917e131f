// SPDX-License-Identifier: MIT
// The shadow map itself, and the flow that instances of techniques share.
#include "renderer/core/paths.h"
#include "renderer/measure/errors.h"
#include "renderer/scene/gpu_scene.h"
#include "renderer/shadow_map/shadow_map.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::vector<float> shadowMapOf(const Session& s) {
    (void)draw(s);
    Renderer& r = renderer();
    return r.read(*r.flow().find("hard.shadow-map")).values;
}

SceneBuilder someBoxes() {
    return SceneBuilder()
        .box({-3, -0.2f, -3}, {3, 0, 3})
        .box({-1, 0, -1}, {0, 1, 0})
        .box({0.2f, 0.8f, 0.2f}, {0.9f, 1, 1.4f});
}

// A GPU-free bench for flows: one view, a geometry buffer out of nothing, and as many lights as asked for.
struct Bench {
    Flow flow;
    View view = makeView({}, {64, 48}, 0.1f, 10);
    std::vector<Occluder> occluders{{{{-1, 0, -1}, {1, 1, 1}}, true}};
    std::optional<GeometryBuffer> surfaces;

    Bench() { begin(); }
    void begin() {
        flow.begin();
        const auto images =
            flow.pass({.owner = "scene"},
                      {.name = "geometry-buffer",
                       .work = Compute{"demo.glsl"},
                       .writes = {{"depth", Format::R32F, {64, 48}}, {"normal", Format::RGBA16Snorm, {64, 48}}}});
        surfaces = GeometryBuffer{images[0], images[1], {}};
    }
    Image build(const Technique& technique, std::string_view id, std::string_view instance, const AreaLight& light) {
        const Inputs inputs{view, light, *surfaces, nullptr, 1, occluders, 0, 0};
        return technique.build(flow, {instance, id}, inputs);
    }
    int shadowMaps() const {
        int count = 0;
        for (const Flow::PassNode& pass : flow.passes()) count += pass.stage == Stage::ShadowMap;
        return count;
    }
};

} // namespace

TEST_CASE("instances of one technique under two lights keep apart, and equal shadow maps are drawn once") {
    const auto a = makeTechnique(findCard("pcf")), b = makeTechnique(findCard("pcf")),
               c = makeTechnique(findCard("pcss"));
    b->parameters().at("kernel").set(9);
    c->parameters().at("fit").setText("scene");
    const AreaLight first, second{.position = {2, 5, 0}};
    Bench bench;
    const Image psiA = bench.build(*a, "pcf", "a", first);
    const Image psiB = bench.build(*b, "pcf", "b", first);
    const Image psiC = bench.build(*c, "pcss", "c", first);
    const Image psiD = bench.build(*a, "pcf", "d", second);
    CHECK(bench.shadowMaps() == 2); // a, b and c look at the same one; the second light has its own
    const auto& flow = bench.flow;
    CHECK(flow.find("a/pcf.shadow-map") == flow.find("b/pcf.shadow-map"));
    CHECK(flow.find("a/pcf.shadow-map") == flow.find("c/pcss.shadow-map"));
    CHECK_FALSE(flow.find("a/pcf.shadow-map") == flow.find("d/pcf.shadow-map"));
    CHECK(flow.label(psiA) == "a/pcf.shadow");
    CHECK(flow.label(psiB) == "b/pcf.shadow");
    CHECK_FALSE(psiA == psiB); // other kernel
    CHECK_FALSE(psiA == psiC);
    CHECK_FALSE(psiA == psiD);
    CHECK(a->parameters().at("kernel").value() == 5); // b's value is b's alone

    // Another map size is another map; the same one in all instances is one again.
    bench.begin();
    b->parameters().at("map-size").set(512);
    (void)bench.build(*a, "pcf", "a", first);
    (void)bench.build(*b, "pcf", "b", first);
    CHECK(bench.shadowMaps() == 2);
}

TEST_CASE("what lies on the reference plane is at the same place for every sample of the light") {
    Bench bench;
    for (const LightShape shape : {LightShape::Rectangle, LightShape::Directional}) {
        const AreaLight light{.shape = shape, .position = {1, 5, 1}, .target = {0, 0, 0}, .size = {1, 1}};
        const Inputs inputs{bench.view, light, *bench.surfaces, nullptr, 1, bench.occluders, 0, 0};
        const glm::vec2 half = halfSize(light);
        const LightViewBlock centre = lightView(inputs, {.size = 256});
        for (const glm::vec2 s : {half, -half, glm::vec2(half.x, -half.y)})
            for (const bool averaged : {false, true}) {
                const LightViewBlock view = lightView(inputs, {.size = 256, .sample = s, .averaged = averaged});
                CHECK(view.range == centre.range);
                const float f = view.sample_reference.z;
                for (const glm::vec2 p : {glm::vec2(0.1f, 0.2f), glm::vec2(-0.4f, 0.3f)}) {
                    const glm::vec4 world = glm::inverse(view.lightFromWorld) * glm::vec4(p, -f, 1);
                    const glm::vec4 clip = view.clipFromWorld * world;
                    const glm::vec2 place = glm::vec2(clip) / clip.w,
                                    expected = (p - glm::vec2(view.window)) / glm::vec2(view.window.z, view.window.w);
                    CHECK(glm::distance(place, expected) < 1e-4f);
                }
            }
    }
}

TEST_CASE("the map covers every caster from every corner of the light") {
    Bench bench;
    for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
        const AreaLight light{.shape = shape, .position = {1, 5, 1}, .target = {0, 0, 0}, .size = {2, 2}};
        const Inputs inputs{bench.view, light, *bench.surfaces, nullptr, 1, bench.occluders, 0, 0};
        const glm::vec2 half = halfSize(light);
        for (const glm::vec2 s : {lightCentre, half, -half}) {
            const LightViewBlock view = lightView(inputs, {.size = 256, .sample = s});
            for (int i = 0; i < 8; ++i) {
                const glm::vec4 corner(i & 1 ? 1 : -1, i & 2 ? 1 : 0, i & 4 ? 1 : -1, 1);
                const glm::vec4 clip = view.clipFromWorld * corner;
                CHECK(std::abs(clip.x) <= clip.w);
                CHECK(std::abs(clip.y) <= clip.w);
                CHECK((clip.z >= 0 && clip.z <= clip.w));
            }
        }
    }
}

TEST_CASE("a map that is fitted to the view has finer texels there, and loses nothing that casts into it") {
    // From close to a box of many: the shadow of a board that is out of the view falls into it.
    SceneBuilder builder;
    builder.floor(20).box({-0.2f, 0, -0.2f}, {0.2f, 0.4f, 0.2f}).box({-2, 2, -0.5f}, {-1, 2.1f, 0.5f});
    for (int i = 0; i < 6; ++i) builder.box({-15 + 5.0f * float(i), 0, -12}, {-14 + 5.0f * float(i), 3, -11});
    Session s = session(builder.build(), "light-sampling");
    s.light = {.shape = LightShape::Rectangle, .position = {-3, 5, 0}, .target = {0, 0, 0}, .size = {0.5f, 0.5f}};
    s.camera = {.eye = {1, 1.2f, 1.5f}, .target = {0, 0.2f, 0}, .fovY = 40};
    s.progressive = false;
    s.techniques.assign("samples=64");
    s.techniques.assign("map-size=256");
    renderer().reset();
    renderer().render(s);
    const Truth truth = traceTruth(readTruthInput(renderer(), s), {.leastSamples = 256, .mostSamples = 256});
    const auto error = [&](const char* fit) {
        s.techniques.assign(fit);
        return errorsOf(draw(s).psi.values, truth).all.rmse;
    };
    const double scene = error("fit=scene"), view = error("fit=view");
    CAPTURE(scene, view);
    CHECK(view < 0.5 * scene);

    Bench bench;
    bench.occluders = renderer().state().occluders();
    bench.view = renderer().view();
    const Inputs inputs{bench.view, s.light, *bench.surfaces, nullptr, 1, bench.occluders, 0, 0};
    const float wide = lightView(inputs, {.size = 256}).window.z;
    CHECK(lightView(inputs, {.size = 256, .fit = Fit::View}).window.z < 0.5f * wide);
}

TEST_CASE("stored depth is linear and right, for perspective and directional lights") {
    for (const LightShape shape : {LightShape::Rectangle, LightShape::Directional}) {
        Session s = session(SceneBuilder().floor(3, 30).build(), "hard");
        s.light.shape = shape;
        s.techniques.assign("map-size=64");
        s.techniques.assign("fit=scene");
        const std::vector<float> map = shadowMapOf(s);
        const Flow& flow = renderer().flow();
        const View view = sessionView(s, renderer().state().bounds());
        const Inputs inputs{view,    s.light, {*flow.find("scene.depth"), *flow.find("scene.normal"), {}},
                            nullptr, 0,       renderer().state().occluders(),
                            0,       0};
        const LightViewBlock light = lightView(inputs, {.size = 64});
        int compared = 0;
        for (int y = 8; y < 56; y += 5)
            for (int x = 8; x < 56; x += 5) {
                // The ray through the texel's centre meets the floor y = −tan 30° z at one depth.
                const glm::vec2 uv((static_cast<float>(x) + 0.5f) / 64, (static_cast<float>(y) + 0.5f) / 64);
                const glm::vec2 p =
                    glm::vec2(light.window) + (2.0f * uv - 1.0f) * glm::vec2(light.window.z, light.window.w);
                const float f = light.sample_reference.z;
                const glm::vec3 through = glm::vec3(glm::inverse(light.lightFromWorld) * glm::vec4(p, -f, 1));
                const glm::vec3 from =
                    shape == LightShape::Directional ? through + glm::vec3(0, 100, 0) : s.light.position;
                const glm::vec3 n(0, std::cos(glm::radians(30.0f)), std::sin(glm::radians(30.0f)));
                const glm::vec3 ray = through - from;
                const glm::vec3 hit = from - ray * (glm::dot(n, from) / glm::dot(n, ray));
                const float d = s.light.position.y - hit.y;
                const float stored = map[static_cast<size_t>((63 - y) * 64 + x)]; // read back from the top row down
                if (std::max(std::abs(hit.x), std::hypot(hit.y, hit.z)) > 2.9f) continue;
                CHECK(stored == Approx((d - light.range.x) * light.range.z).margin(2e-4));
                ++compared;
            }
        CHECK(compared > 20);
    }
}

TEST_CASE("a radial map stores the distance from the light's point") {
    (void)renderer(); // for its context
    Bench bench;
    AreaLight light{.position = {1, 5, 1}, .target = {0, 0, 0}, .size = {2, 2}};
    const Inputs inputs{bench.view, light, *bench.surfaces, nullptr, 1, bench.occluders, 0, 0};
    const ShadowMapDescription axial{.size = 64}, radial{.size = 64, .metric = Metric::Radial};
    const ShadowMap a = drawShadowMap(bench.flow, {"a", "demo"}, inputs, axial);
    const ShadowMap b = drawShadowMap(bench.flow, {"b", "demo"}, inputs, radial);
    CHECK_FALSE(a.depth == b.depth);
    for (const glm::vec2 s : {lightCentre, halfSize(light), -halfSize(light)}) {
        const LightViewBlock view = lightView(inputs, {.size = 64, .sample = s, .metric = Metric::Radial});
        CHECK(view.range == b.view.range);
        for (int i = 0; i < 8; ++i) {
            const glm::vec4 corner(i & 1 ? 1 : -1, i & 2 ? 1 : 0, i & 4 ? 1 : -1, 1);
            const float distance = glm::length(glm::vec3(view.lightFromWorld * corner) - glm::vec3(s, 0));
            CHECK((distance >= view.range.x && distance <= view.range.y)); // z stays in [0, 1]
        }
    }
    light.shape = LightShape::Directional;
    CHECK_THROWS_AS(lightView(inputs, radial), std::logic_error);
}

TEST_CASE("a map may be a float image, have samples, and show the surfaces behind the nearest") {
    // Two sheets over a floor; the lower one is wider.
    Session s = session(SceneBuilder()
                            .floor(3)
                            .quad({-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1})
                            .quad({-0.3f, 2, 0.3f}, {0.3f, 2, 0.3f}, {0.3f, 2, -0.3f}, {-0.3f, 2, -0.3f})
                            .build(),
                        "hard");
    for (const LightShape shape : {LightShape::Rectangle, LightShape::Directional}) {
        s.light.shape = shape;
        (void)draw(s); // poses the scene
        const GpuScene geometry(renderer().state());
        ProgramLibrary programs(shaderFolder());
        FlowRunner runner(programs);
        Bench bench;
        const Inputs inputs{bench.view, s.light, *bench.surfaces, &geometry, 1, renderer().state().occluders(), 0, 0};
        const auto centreOf = [&](const ShadowMapDescription& description) {
            bench.flow.begin();
            const ShadowMap map = drawShadowMap(bench.flow, {.owner = "demo"}, inputs, description);
            runner.run(bench.flow, Timing::Off);
            const float z = runner.texture(bench.flow, map.depth).read()[64 * 32 + 32];
            return z == 1 ? 0.0f : s.light.position.y - (z / map.view.range.z + map.view.range.x);
        };
        CAPTURE(int(shape));
        for (const Format format : {Format::Depth32F, Format::R32F}) {
            CHECK(centreOf({.size = 64, .format = format}) == Approx(2).margin(1e-3));
            CHECK(centreOf({.size = 64, .format = format, .layer = 1}) == Approx(1).margin(1e-3));
            CHECK(centreOf({.size = 64, .format = format, .layer = 2}) == Approx(0).margin(1e-3));
            CHECK(centreOf({.size = 64, .format = format, .layer = 3}) == 0); // nothing there
        }
        // Four samples are what every driver offers; three are refused with those that there are.
        bench.flow.begin();
        (void)drawShadowMap(bench.flow, {.owner = "demo"}, inputs, {.size = 64, .samples = 4});
        runner.run(bench.flow, Timing::Off);
        bench.flow.begin();
        (void)drawShadowMap(bench.flow, {.owner = "demo"}, inputs, {.size = 64, .samples = 3});
        CHECK_THROWS_WITH(runner.run(bench.flow, Timing::Off), contains("demo.shadow-map-samples: 3 samples a texel"));
    }
    CHECK(driverMessages().empty());
}

TEST_CASE("drawing only the fronts of closed surfaces gives the same map") {
    // The same boxes, closed, and each with a triangle twice so that they do not count as closed.
    SceneBuilder closed = someBoxes(), open = someBoxes();
    open.twice();
    for (const glm::vec3 position : {glm::vec3(0, 4, 0), glm::vec3(3, 3, -2)}) {
        Session s = session(closed.merged(), "hard");
        s.light.position = position;
        const std::vector<float> fronts = shadowMapOf(s);
        REQUIRE(renderer().state().occluders()[0].closed);
        s.scene = open.merged();
        const std::vector<float> both = shadowMapOf(s);
        REQUIRE_FALSE(renderer().state().occluders()[0].closed);
        float largest = 0; // rounding of two faces that meet in one texel
        for (size_t i = 0; i < both.size(); ++i) largest = std::max(largest, std::abs(fronts[i] - both[i]));
        CHECK(largest < 1e-5f);
    }
    // From inside a box its back is all there is to see.
    Session s = session(SceneBuilder().box({-3, -1, -3}, {3, 5, 3}).merged(), "hard");
    const std::vector<float> map = shadowMapOf(s);
    CHECK(std::count_if(map.begin(), map.end(), [](float z) { return z < 1; }) > 100000);
}

TEST_CASE("a mask has holes in the view and in the shadow, and a texture colours only what wears it") {
    // Left quad: textured, red; right quad: masked, right half transparent; floor: plain.
    auto scene =
        std::make_shared<Scene>(*SceneBuilder()
                                     .floor(3)
                                     .quad({-1, 1, 0.5f}, {0, 1, 0.5f}, {0, 1, -0.5f}, {-1, 1, -0.5f})
                                     .quad({0.5f, 1, 0.5f}, {1.5f, 1, 0.5f}, {1.5f, 1, -0.5f}, {0.5f, 1, -0.5f})
                                     .build());
    scene->textures.push_back({.name = "red", .rgba = {255, 0, 0, 255}});
    scene->textures.push_back({.name = "half",
                               .width = 2,
                               .rgba = {255, 255, 255, 255, 255, 255, 255, 0},
                               .wrapU = Wrap::ClampToEdge,
                               .magnifyNearest = true});
    scene->materials.push_back({.texture = 0, .doubleSided = true});
    scene->materials.push_back({.texture = 1, .masked = true, .doubleSided = true});
    for (size_t m = 2; m < 6; ++m) scene->meshes[m].primitives[0].material = m < 4 ? 1 : 2;
    for (size_t m = 4; m < 6; ++m) {
        const Primitive& p = scene->meshes[m].primitives[0];
        for (uint32_t v = p.firstVertex; v < p.firstVertex + 3; ++v)
            scene->uvs[v] = {scene->positions[v].x - 0.5f, 0.5f};
    }
    Session s = session(scene, "hard");
    s.display.show = Show::Lit;
    s.camera = {.eye = {0, 8, 0.01f}, .target = {0, 0, 0}};
    s.size = {160, 120};
    s.light.position = {0, 100, 0}; // nearly parallel: shadows lie under what casts
    const ShadowImage image = draw(s);
    const Renderer::Pixels colour = renderer().read(*renderer().flow().find("scene.colour"));
    int holes = 0, red = 0, plain = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            if (!image.surface(x, y)) continue;
            const glm::vec3 p = image.positionWorld(x, y);
            const float* c = &colour.values[image.index(x, y) * static_cast<size_t>(colour.channels)];
            if (p.y > 0.9f) {
                CHECK(p.x < 1.03f); // the transparent half is not there
                if (p.x < 0) {
                    CHECK((c[0] == Approx(1).margin(0.01) && c[1] == Approx(0).margin(0.01)));
                    ++red;
                }
            } else {
                CHECK((c[0] == Approx(1).margin(0.01) && c[1] == Approx(1).margin(0.01)));
                ++plain;
                // Seen through the hole: lit there, dark under what is left of the masked quad.
                if (p.x > 1.05f && p.x < 1.4f && std::abs(p.z) < 0.4f) {
                    CHECK(image.at(x, y) == 0);
                    ++holes;
                }
            }
        }
    CHECK(red > 100);
    CHECK(plain > 1000);
    CHECK(holes > 20);
    CHECK(driverMessages().empty());
}

TEST_CASE("layers 5 cm apart do not fight a kilometre away") {
    const auto scene = SceneBuilder()
                           .floor(1000)
                           .quad({-900, 0.05f, 900}, {900, 0.05f, 900}, {900, 0.05f, -900}, {-900, 0.05f, -900})
                           .build();
    Session s = session(scene, "none");
    s.camera = {.eye = {1000, 300, 1000}, .target = {0, 0, 0}};
    s.size = {160, 120};
    const ShadowImage image = draw(s);
    int checked = 0, wrong = 0;
    for (int y = 0; y < image.psi.height; ++y)
        for (int x = 0; x < image.psi.width; ++x) {
            if (!image.surface(x, y)) continue;
            const glm::vec3 p = image.positionWorld(x, y);
            if (std::max(std::abs(p.x), std::abs(p.z)) > 890) continue;
            ++checked;
            wrong += std::abs(p.y - 0.05f) > 0.025f;
        }
    CHECK(checked > 2000);
    CHECK(wrong == 0);
}

TEST_CASE("what shades nothing need not be drawn, and a test of each texel finds the same") {
    Session s = session(std::make_shared<Scene>(importGltf(findScene("two-boxes"))), "light-sampling");
    s.light = {.position = {0, 4, 0}, .target = {0, 0, 0}, .size = {1, 1}};
    s.progressive = false;
    s.techniques.assign("samples=64");
    const ShadowImage image = draw(s);
    const auto map = renderer().flow().find("light-sampling.shadow-map");
    REQUIRE(map);
    const std::vector<float> depths = renderer().read(*map).values;
    const auto empty = std::count(depths.begin(), depths.end(), 1.0f);
    s.techniques.choose("hard"); // whose map has the floor in it
    draw(s);
    const std::vector<float> all = renderer().read(*renderer().flow().find("hard.shadow-map")).values;
    CAPTURE(empty, std::count(all.begin(), all.end(), 1.0f));
    CHECK(std::count(all.begin(), all.end(), 1.0f) + std::ptrdiff_t(all.size() / 5) < empty);
    const Truth truth = traceTruth(readTruthInput(renderer(), s), {.leastSamples = 256, .mostSamples = 256});
    CHECK(errorsOf(image.psi.values, truth).all.rmse < 0.02);
}

TEST_CASE("a floor that everything stands on takes no texels where nothing does") {
    const AreaLight light{.position = {0, 4, 0}};
    std::vector<Occluder> occluders{{.boundsWorld = {{-4, -0.1f, -4}, {4, 0, 4}}},
                                    {.boundsWorld = {{-1, 0, -0.5f}, {-0.3f, 0.8f, 0.3f}}}};
    const auto halfWidth = [&] { return lightView(light, occluders, {}).window.z; };
    const float whole = halfWidth();
    CHECK(whole > 4);
    occluders[0].shadesItself = false;
    const float fitted = halfWidth();
    CHECK(fitted < 1);
    CHECK(fitted > 0.35f); // the box itself
    // Nor does it where the light slants, and the floor is nearer to it in one corner than the box in another.
    const AreaLight slanting{.position = {6, 3, 0}};
    const float wide = lightView(slanting, occluders, {}).window.z;
    occluders[0].shadesItself = true;
    CHECK(wide < 0.5f * lightView(slanting, occluders, {}).window.z);
    occluders[0].shadesItself = false;
    occluders.push_back({.boundsWorld = {{2, -1, 2}, {3, -0.5f, 3}}}); // in the floor's shadow
    CHECK(halfWidth() > 4);
    occluders.back().boundsWorld = {{2, 0.01f, 2}, {3, 0.5f, 3}}; // above it
    CHECK(halfWidth() < 3);
}
