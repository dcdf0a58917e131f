// SPDX-License-Identifier: MIT
// Skins and morph targets on the GPU against the same source run as C++, what moves, and what vertices and materials
// say of colour.
#include "renderer/scene/posing.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <filesystem>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// The scene as it stands at that moment, without skins, morph targets and animations.
std::shared_ptr<const Scene> frozen(const Scene& scene, size_t clip, double seconds) {
    auto still = std::make_shared<Scene>(scene);
    Pose pose;
    evaluatePose(scene, clip, seconds, pose);
    still->animations.clear();
    still->skins.clear();
    still->colours.clear();
    still->meshes.clear();
    still->positions.clear();
    still->nodes.clear();
    std::vector<glm::vec3> positionsWorld;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.visible || node.mesh < 0) continue;
        Node fixed;
        fixed.mesh = static_cast<int>(still->meshes.size());
        still->nodes.push_back(fixed);
        Mesh& mesh = still->meshes.emplace_back();
        for (Primitive primitive : scene.meshes[static_cast<size_t>(node.mesh)].primitives) {
            posedPositions(scene, pose, n, primitive, positionsWorld);
            primitive.firstVertex = static_cast<uint32_t>(still->positions.size());
            primitive.influenceSets = primitive.morphTargets = 0;
            primitive.bounds = {};
            for (const glm::vec3& p : positionsWorld) primitive.bounds.add(p);
            still->positions.insert(still->positions.end(), positionsWorld.begin(), positionsWorld.end());
            mesh.primitives.push_back(primitive);
        }
    }
    still->normals.assign(still->positions.size(), glm::vec3(0));
    still->uvs.assign(still->positions.size(), glm::vec2(0));
    for (Material& material : still->materials) material.texture = -1, material.masked = false;
    return still;
}

// The share of pixels at which the two show different surfaces: only one shows any, or they are a hundredth apart.
float difference(const ShadowImage& a, const ShadowImage& b) {
    int differ = 0;
    for (size_t i = 0; i < a.depth.values.size(); ++i) {
        const float p = a.depth.values[i], q = b.depth.values[i];
        differ += std::abs(p - q) > 0.01f * std::max(p, q);
    }
    return static_cast<float>(differ) / static_cast<float>(a.depth.values.size());
}

} // namespace

TEST_CASE("the GPU poses what the CPU poses") {
    const auto scene = wavingScene();
    Session s = session(scene, "hard");
    s.size = {160, 120};
    for (const double time : {0.0, 0.2, 0.5}) {
        CAPTURE(time);
        s.scene = scene;
        s.time = time;
        const ShadowImage moving = draw(s);
        s.scene = frozen(*scene, 0, time);
        s.time = 0;
        const ShadowImage still = draw(s);
        CHECK(difference(moving, still) < 0.002f); // pixels whose centre an edge crosses by rounding
        int shadows = 0;
        for (size_t i = 0; i < moving.psi.values.size(); ++i) shadows += moving.psi.values[i] != still.psi.values[i];
        CHECK(static_cast<float>(shadows) < 0.005f * static_cast<float>(moving.psi.values.size()));
    }
    // The pose matters: another one gives another picture.
    s.scene = scene;
    s.time = 0;
    const ShadowImage flat = draw(s);
    s.time = 0.5;
    const ShadowImage bent = draw(s);
    CHECK(difference(flat, bent) > 0.02f); // ten times what rounding does
    CHECK(driverMessages().empty());
}

TEST_CASE("real characters stand on the GPU as they do on the CPU") {
    const std::filesystem::path folder = std::filesystem::path(PENUMBRA_SHARED_FOLDER) / "scenes";
    if (!std::filesystem::exists(folder)) {
        WARN("left out: no shared scenes");
        return;
    }
    for (const char* file : {"fox/Fox.glb", "cesium_man/CesiumMan.glb", "robot_expressive/RobotExpressive.glb",
                             "animated_morph_cube/AnimatedMorphCube.gltf"}) {
        CAPTURE(file);
        const auto scene = std::make_shared<const Scene>(importGltf(folder / file));
        Session s = session(scene, "none");
        s.setScene(scene);
        s.size = {160, 120};
        s.ground = false;
        s.time = 0.37;
        s.clip = scene->animations.size() - 1;
        const ShadowImage moving = draw(s);
        s.scene = frozen(*scene, s.clip, s.time);
        CHECK(difference(moving, draw(s)) < 0.002f);
        int surface = 0;
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x) surface += moving.surface(x, y);
        CHECK(surface > 500);
    }
}

TEST_CASE("motion tells where a bent surface was a frame ago, and a pause that it stands still") {
    const auto scene = wavingScene();
    Session s = session(scene, "none");
    s.size = {160, 120};
    const double before = 0.2, after = 0.25;
    s.time = before;
    const ShadowImage first = draw(s);
    s.time = after;
    renderer().render(s); // not the first frame, which moves nothing
    REQUIRE(renderer().flow().find("scene.motion").has_value());
    const Renderer::Pixels motion = renderer().read(*renderer().flow().find("scene.motion"));

    // The board's vertices: where they are, and where they were.
    Pose poseNow, poseBefore;
    evaluatePose(*scene, 0, after, poseNow);
    evaluatePose(*scene, 0, before, poseBefore);
    const size_t node = scene->nodes.size() - 1;
    const Primitive& board = scene->meshes.back().primitives[0];
    std::vector<glm::vec3> are, were;
    posedPositions(*scene, poseNow, node, board, are);
    posedPositions(*scene, poseBefore, node, board, were);
    const View view = sessionView(s, renderer().state().bounds());
    const auto pixelOf = [&](glm::vec3 p) {
        const glm::vec4 clip = view.clipFromWorld * glm::vec4(p, 1);
        return (0.5f + 0.5f * glm::vec2(clip) / clip.w) * glm::vec2(view.size);
    };
    int checked = 0;
    for (size_t v = 0; v + 1 < are.size(); v += 2) {
        // The middle of the board, between two vertices, so that it is inside of it.
        const glm::vec2 here = pixelOf(0.5f * (are[v] + are[v + 1])), there = pixelOf(0.5f * (were[v] + were[v + 1]));
        const int x = static_cast<int>(here.x), y = 119 - static_cast<int>(here.y);
        if (x < 1 || x > 158 || y < 1 || y > 118) continue;
        const float* m = &motion.values[first.index(x, y) * static_cast<size_t>(motion.channels)];
        CAPTURE(v, x, y);
        CHECK(m[0] == Approx(there.x - here.x).margin(0.35));
        CHECK(m[1] == Approx(there.y - here.y).margin(0.35));
        ++checked;
    }
    CHECK(checked > 5);

    renderer().render(s); // the same moment again
    CHECK_FALSE(renderer().flow().find("scene.motion").has_value());
}

TEST_CASE(
    "colours of vertices multiply the material's, their alpha the mask's, and the unlit and glowing shine in shadow") {
    auto scene =
        std::make_shared<Scene>(*SceneBuilder().floor(3).quad({-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}).build());
    scene->materials[0].baseColour = {0.5f, 1, 1, 1};
    scene->colours.assign(scene->positions.size(), glm::u16vec4(65535, 65535, 0, 65535));
    Session s = session(scene, "hard");
    s.display.show = Show::Lit;
    s.size = {40, 30};
    s.camera = {.eye = {0, 0.8f, 0.9f}, .target = {0, 0, 0}}; // below the quad, in its shadow
    s.light.size = {0.1f, 0.1f};
    const auto pixel = [&](const char* label) {
        (void)draw(s);
        const Renderer::Pixels p = renderer().read(*renderer().flow().find(label));
        const size_t at = (static_cast<size_t>(15) * 40 + 20) * static_cast<size_t>(p.channels);
        return glm::vec4(p.values[at], p.values[at + 1], p.values[at + 2], p.channels > 3 ? p.values[at + 3] : 0);
    };
    const glm::vec4 colour = pixel("scene.colour");
    CHECK(colour.r * colour.r == Approx(0.5).margin(0.01));
    CHECK(colour.g == Approx(1).margin(0.01));
    CHECK(colour.b == 0);
    const float dark = pixel("lit").g;
    CHECK(dark < 0.5f);

    const auto with = [&](auto&& change) {
        auto changed = std::make_shared<Scene>(*scene);
        change(*changed);
        s.scene = changed;
    };
    with([](Scene& c) { c.materials[0].unlit = true; });
    CHECK(pixel("lit").g == Approx(1).margin(0.01));
    with([](Scene& c) { c.materials[0].emissive = {0, 0, 0.8f}; });
    CHECK(pixel("lit").b > 0.5f);

    // A cutoff of 0.5, alphas of 1 · 0.4: the quad is not there, and neither is its shadow.
    with([](Scene& c) {
        c.materials[0].masked = true;
        for (size_t v = 6; v < c.colours.size(); ++v) c.colours[v].a = 0.4f * 65535; // the quad's
    });
    CHECK(pixel("lit").g > 2 * dark);
    CHECK(driverMessages().empty());
}
