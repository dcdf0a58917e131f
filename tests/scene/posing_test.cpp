// SPDX-License-Identifier: MIT
#include "renderer/scene/posing.h"
#include "renderer/scene/scene_state.h"
#include "tests/catch.h"

#include <cmath>
#include <filesystem>

using namespace penumbra;

namespace {

// A bar of four vertices along x, at 0, 1, 2 and 3 m; the two at its far end hang on a second joint at x = 1.5 m.
std::shared_ptr<Scene> bar() {
    auto scene = std::make_shared<Scene>();
    scene->materials.emplace_back();
    for (int i = 0; i < 4; ++i) {
        scene->positions.emplace_back(i, 0, 0);
        scene->normals.emplace_back(0, 1, 0);
        scene->uvs.emplace_back(0);
        scene->influences.push_back({.joints = glm::u16vec4(i < 2 ? 0 : 1, 0, 0, 0), .weights = {1, 0, 0, 0}});
    }
    scene->indices = {0, 1, 2, 1, 2, 3};
    Primitive primitive{.indexCount = 6, .vertexCount = 4, .influenceSets = 1};
    for (const glm::vec3 p : scene->positions) primitive.bounds.add(p);
    primitive.jointBounds = {{0, {{0, 0, 0}, {1, 0, 0}}}, {1, {{2, 0, 0}, {3, 0, 0}}}};
    scene->meshes.push_back({"bar", {primitive}});
    Node root, joint, body;
    joint.translation = {1.5f, 0, 0};
    joint.parent = 0;
    body.mesh = 0;
    body.skin = 0;
    body.translation = {7, 7, 7}; // has no effect: joints alone place a skinned mesh
    scene->nodes = {root, joint, body};
    Skin skin{.joints = {0, 1}, .jointFromMesh = {glm::mat4(1), glm::mat4(1)}};
    skin.jointFromMesh[1][3] = {-1.5f, 0, 0, 1};
    scene->skins.push_back(skin);
    return scene;
}

void animate(Scene& scene, int node, AnimationChannel::Path path, std::vector<float> from, std::vector<float> to) {
    AnimationChannel channel{.node = node, .path = path, .width = uint32_t(from.size()), .times = {0, 1}};
    channel.values = std::move(from);
    channel.values.insert(channel.values.end(), to.begin(), to.end());
    scene.animations.push_back({.name = "clip", .duration = 1, .channels = {channel}});
}

std::vector<glm::vec3> posed(const Scene& scene, size_t node, double seconds) {
    Pose pose;
    evaluatePose(scene, 0, seconds, pose);
    std::vector<glm::vec3> positionsWorld;
    posedPositions(scene, pose, node, scene.meshes[size_t(scene.nodes[node].mesh)].primitives[0], positionsWorld);
    return positionsWorld;
}

using Path = AnimationChannel::Path;

} // namespace

TEST_CASE("a joint turns what hangs on it about itself and leaves the rest") {
    const auto scene = bar();
    const float s = std::sqrt(0.5f);
    animate(*scene, 1, Path::Rotation, {0, 0, 0, 1}, {0, 0, s, s}); // a quarter turn about z
    const std::vector<glm::vec3> rest = posed(*scene, 2, 0), turned = posed(*scene, 2, 0.999999);
    for (int i = 0; i < 4; ++i) CHECK(glm::distance(rest[size_t(i)], glm::vec3(i, 0, 0)) < 1e-6f);
    CHECK(glm::distance(turned[1], glm::vec3(1, 0, 0)) < 1e-6f);
    CHECK(glm::distance(turned[2], glm::vec3(1.5f, 0.5f, 0)) < 1e-4f);
    CHECK(glm::distance(turned[3], glm::vec3(1.5f, 1.5f, 0)) < 1e-4f);
}

TEST_CASE("a vertex of two joints lies between what each would make of it") {
    const auto scene = bar();
    scene->influences[2] = {.joints = glm::u16vec4(0, 1, 0, 0), .weights = {0.25f, 0.75f, 0, 0}};
    animate(*scene, 1, Path::Translation, {1.5f, 0, 0}, {1.5f, 4, 0});
    CHECK(glm::distance(posed(*scene, 2, 0.5)[2], glm::vec3(2, 0.75f * 2, 0)) < 1e-6f);
    CHECK(glm::distance(posed(*scene, 2, 0.5)[3], glm::vec3(3, 2, 0)) < 1e-6f);
}

TEST_CASE("morph targets add up by their weights, before the joints") {
    const auto scene = bar();
    Primitive& primitive = scene->meshes[0].primitives[0];
    primitive.morphTargets = 2;
    scene->morphDeltas.resize(8);
    scene->morphDeltas[3].position = {0, 1, 0};     // target 0, vertex 3
    scene->morphDeltas[4 + 3].position = {0, 0, 2}; // target 1, vertex 3
    primitive.morphBounds = {{{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 0, 2}}};
    scene->restWeights = {0.5f, 0};
    animate(*scene, 2, Path::Weights, {0, 0}, {1, -3});
    CHECK(glm::distance(posed(*scene, 2, 0.5)[3], glm::vec3(3, 0.5f, -3)) < 1e-6f);
    Pose rest;
    evaluatePose(*scene, 7, 0.5, rest); // no such clip: the weights at rest
    CHECK(rest.morphWeights == scene->restWeights);

    Pose pose;
    evaluatePose(*scene, 0, 0.5, pose);
    const Bounds bounds = posedBounds(*scene, pose, 2, primitive);
    CHECK(glm::distance(bounds.min, glm::vec3(0, 0, -3)) < 1e-6f);
    CHECK(glm::distance(bounds.max, glm::vec3(3, 0.5f, 0)) < 1e-6f);
}

TEST_CASE("each thing moves by itself, and a paused scene is a still scene") {
    const auto scene = bar();
    Node other;
    other.mesh = 0; // the same mesh without a skin
    scene->nodes.push_back(other);
    animate(*scene, 1, Path::Translation, {1.5f, 0, 0}, {1.5f, 4, 0});
    SceneState state;
    state.setScene(scene);
    state.update(0, 0.1, false);
    CHECK_FALSE(state.moving());
    CHECK(state.posing()); // for the first time
    const uint64_t first = state.poseVersion();
    state.update(0, 0.2, false);
    CHECK(state.moving());
    REQUIRE(state.occluders().size() == 2);
    CHECK(state.occluders()[0].moved);       // the skinned bar
    CHECK_FALSE(state.occluders()[1].moved); // its rigid twin
    CHECK(state.poseVersion() != first);
    const uint64_t second = state.poseVersion();
    state.update(0, 0.2, false);
    CHECK_FALSE(state.moving());
    CHECK_FALSE(state.occluders()[0].moved);
    CHECK(state.posing()); // once more, so that the last positions catch up
    CHECK(state.poseVersion() == second);
    state.update(0, 0.2, false);
    CHECK_FALSE(state.posing());
}

TEST_CASE("a scene that no clip moves is not posed again") {
    const auto scene = bar();
    SceneState state;
    state.setScene(scene);
    state.update(0, 0, false);
    CHECK(state.posing());
    state.update(0, 5, false);
    CHECK_FALSE(state.posing());
    CHECK_FALSE(state.moving());
}

TEST_CASE("keys that drive a node beyond all measure shrink it to nothing") {
    Scene scene;
    scene.nodes.resize(6);
    for (size_t i = 0; i < 6; ++i) {
        scene.nodes[i].parent = int(i) - 1;
        AnimationChannel channel{.node = int(i), .path = Path::Scale, .times = {0}, .values = {1e9f, 1e9f, 1e9f}};
        if (scene.animations.empty()) scene.animations.push_back({.name = "grow", .duration = 1});
        scene.animations[0].channels.push_back(channel);
    }
    Pose pose;
    evaluatePose(scene, 0, 0, pose);
    for (const glm::mat4& matrix : pose.worldFromNode)
        for (int i = 0; i < 16; ++i) CHECK(std::isfinite(matrix[i / 4][i % 4]));
}
