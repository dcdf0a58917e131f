// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"
#include "tests/catch.h"

#include <array>
#include <cmath>
#include <random>

using namespace penumbra;

namespace {

// Axis-parallel boxes of two triangles a face, wound counter-clockwise seen from outside.
Scene boxes(const std::vector<Bounds>& list) {
    Scene scene;
    scene.materials.emplace_back();
    for (const Bounds& box : list) {
        Primitive primitive;
        primitive.firstVertex = uint32_t(scene.positions.size());
        primitive.firstIndex = uint32_t(scene.indices.size());
        for (int corner = 0; corner < 8; ++corner)
            scene.positions.emplace_back(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                         corner & 4 ? box.max.z : box.min.z);
        const std::array<std::array<uint32_t, 4>, 6> faces{
            {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
        for (const auto& f : faces) scene.indices.insert(scene.indices.end(), {f[0], f[1], f[2], f[0], f[2], f[3]});
        primitive.indexCount = 36;
        primitive.vertexCount = 8;
        primitive.bounds = box;
        scene.meshes.push_back({.name = "box", .primitives = {primitive}});
        Node node;
        node.mesh = int(scene.meshes.size()) - 1;
        scene.nodes.push_back(node);
    }
    scene.normals.assign(scene.positions.size(), glm::vec3(0, 1, 0));
    scene.uvs.resize(scene.positions.size());
    return scene;
}

Pose poseAt(const Scene& scene, double seconds) {
    Pose pose;
    evaluatePose(scene, 0, seconds, pose);
    return pose;
}

// One node whose `path` is animated.
Scene animated(AnimationChannel::Path path, AnimationChannel::Interpolation interpolation, std::vector<float> times,
               const std::vector<glm::vec4>& values) {
    Scene scene;
    scene.nodes.emplace_back();
    AnimationChannel channel{.path = path, .interpolation = interpolation, .times = std::move(times)};
    channel.width = path == AnimationChannel::Path::Rotation ? 4 : 3;
    for (const glm::vec4& value : values)
        for (uint32_t i = 0; i < channel.width; ++i) channel.values.push_back(value[int(i)]);
    Animation animation{.duration = channel.times.back()};
    animation.channels.push_back(std::move(channel));
    scene.animations.push_back(std::move(animation));
    return scene;
}

glm::vec3 positionAt(const Scene& scene, double seconds) {
    return glm::vec3(poseAt(scene, seconds).worldFromNode[0][3]);
}

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

} // namespace

TEST_CASE("step and linear keys are met and followed") {
    const std::vector<glm::vec4> values{{0, 0, 0, 0}, {2, 4, 6, 0}, {0, 0, 0, 0}};
    const Scene step = animated(Path::Translation, Interpolation::Step, {1, 2, 4}, values);
    CHECK(positionAt(step, 0) == glm::vec3(0));
    CHECK(positionAt(step, 1.999) == glm::vec3(0));
    CHECK(positionAt(step, 2) == glm::vec3(2, 4, 6));
    CHECK(positionAt(step, 3.9) == glm::vec3(2, 4, 6));

    const Scene linear = animated(Path::Translation, Interpolation::Linear, {1, 2, 4}, values);
    CHECK(positionAt(linear, 0.5) == glm::vec3(0));
    CHECK(positionAt(linear, 1.5) == glm::vec3(1, 2, 3));
    CHECK(positionAt(linear, 3) == glm::vec3(1, 2, 3));
    CHECK(positionAt(linear, 4 + 1.5) == glm::vec3(1, 2, 3)); // repeats
    CHECK(positionAt(linear, -8 + 1.5) == glm::vec3(1, 2, 3));
}

TEST_CASE("a cubic spline goes through its keys with the slopes that they state") {
    // The parabola x = t² between t = 1 and t = 3, whose slope is 2t, is a cubic that must be met exactly.
    const std::vector<glm::vec4> values{glm::vec4(2), glm::vec4(1), glm::vec4(2),
                                        glm::vec4(6), glm::vec4(9), glm::vec4(6)};
    const Scene scene = animated(Path::Translation, Interpolation::CubicSpline, {1, 3}, values);
    for (const double t : {1.0, 1.25, 1.7, 2.0, 2.6, 2.99}) {
        CAPTURE(t);
        CHECK(positionAt(scene, t).x == Approx(t * t).epsilon(1e-5));
    }
}

TEST_CASE("rotations turn at an even pace and stay rotations") {
    const float s = std::sqrt(0.5f);
    // A quarter turn about y, the second key stored negated: the short way is taken all the same.
    const Scene linear = animated(Path::Rotation, Interpolation::Linear, {0, 1}, {{0, 0, 0, 1}, {0, -s, 0, -s}});
    for (const float t : {0.0f, 0.25f, 0.5f, 0.9f}) {
        const glm::vec3 x = glm::vec3(poseAt(linear, t).worldFromNode[0][0]);
        const float angle = t * glm::radians(90.0f);
        CHECK(glm::distance(x, glm::vec3(std::cos(angle), 0, -std::sin(angle))) < 1e-5f);
    }
    const Scene cubic = animated(Path::Rotation, Interpolation::CubicSpline, {0, 1},
                                 {{0, 0, 0, 0}, {0, 0, 0, 1}, {0, 9, 0, 0}, {0, 0, 0, 0}, {0, s, 0, s}, {0, 0, 0, 0}});
    for (const float t : {0.1f, 0.5f, 0.8f})
        CHECK(glm::determinant(glm::mat3(poseAt(cubic, t).worldFromNode[0])) == Approx(1).epsilon(1e-4));
}

TEST_CASE("children follow their parents and an animation only replaces what it names") {
    Scene scene = animated(Path::Translation, Interpolation::Linear, {0, 2}, {{0, 0, 0, 0}, {10, 0, 0, 0}});
    scene.nodes[0].scale = glm::vec3(2);
    Node child;
    child.parent = 0;
    child.translation = {0, 1, 0};
    scene.nodes.push_back(child);
    const Pose pose = poseAt(scene, 1);
    CHECK(glm::vec3(pose.worldFromNode[1][3]) == glm::vec3(5, 2, 0));
    CHECK(pose.worldFromNode[1][0][0] == 2);
}

TEST_CASE("a pose that has its size is evaluated without allocation") {
    const Scene scene = animated(Path::Translation, Interpolation::Linear, {0, 1}, {{0, 0, 0, 0}, {1, 0, 0, 0}});
    Pose pose = poseAt(scene, 0);
    const glm::mat4* const memory = pose.worldFromNode.data();
    evaluatePose(scene, 0, 0.5, pose);
    CHECK(pose.worldFromNode.data() == memory);
    CHECK(pose == poseAt(scene, 0.5));
}

TEST_CASE("bounds follow the pose and leave out what is not visible") {
    Scene scene = boxes({{glm::vec3(-1), glm::vec3(1)}, {glm::vec3(100), glm::vec3(101)}});
    scene.nodes[0].rotation = glm::angleAxis(glm::radians(45.0f), glm::vec3(0, 1, 0));
    scene.nodes[1].visible = false;
    const Bounds bounds = worldBounds(scene, poseAt(scene, 0));
    CHECK(bounds.max.x == Approx(std::sqrt(2.0f)));
    CHECK(bounds.max.y == Approx(1));
    CHECK(scene.triangleCount() == 12);
    CHECK(worldBounds(Scene(), Pose()).empty());
}

TEST_CASE("default camera and light suit scenes of any scale, and none at all") {
    for (const float size : {0.006f, 1.0f, 30.0f, 2000.0f}) {
        CAPTURE(size);
        const Bounds bounds{glm::vec3(5 * size, 0, -size), glm::vec3(6 * size, size, size)};
        const Scene scene = boxes({bounds});
        const Pose pose = poseAt(scene, 0);
        const float diagonal = bounds.diagonal();

        // Every corner is in the picture, also in a square one.
        const Camera camera = defaultCamera(scene, pose);
        CHECK(camera.eye.y > bounds.max.y);
        const View view = makeView(camera, {512, 512}, 0.01f * size, 100 * size);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec4 clip = view.clipFromWorld * glm::vec4(scene.positions[size_t(corner)], 1);
            CHECK((clip.w > 0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w));
        }

        const AreaLight light = defaultLight(scene, pose);
        CHECK(light.shape == LightShape::Rectangle);
        CHECK(light.size.x == Approx(diagonal / 10));
        CHECK(glm::distance(light.position, bounds.centre()) == Approx(1.2f * diagonal));
        CHECK(light.position.y > bounds.max.y);
        CHECK(light.target == bounds.centre());

        const Ground ground = groundBelow(scene, pose);
        CHECK(ground.height == bounds.min.y);
        // The corner of the shadow that lies farthest away from the light is caught.
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p = scene.positions[size_t(corner)], ray = p - light.position;
            const glm::vec3 hit = p + ray * ((ground.height - p.y) / ray.y);
            CHECK(std::abs(hit.x - ground.centre.x) < ground.halfSize);
            CHECK(std::abs(hit.z - ground.centre.y) < ground.halfSize);
        }
    }
    const Camera camera = defaultCamera(Scene(), Pose());
    const AreaLight light = defaultLight(Scene(), Pose());
    CHECK(glm::distance(camera.eye, camera.target) == Approx(2.26f).margin(0.01f));
    CHECK(light.size.x > 0);
    CHECK(light.position.y > 1);
}

TEST_CASE("a ground is wanted where nothing lies below") {
    const Bounds block{glm::vec3(-0.5f, 0, -0.5f), glm::vec3(0.5f, 1, 0.5f)};
    const Bounds floor{glm::vec3(-2, -0.1f, -2), glm::vec3(2, 0, 2)};
    const Bounds narrow{glm::vec3(-0.2f, -0.1f, -0.2f), glm::vec3(0.2f, 0, 0.2f)};
    const auto wants = [](const Scene& scene) { return wantsGround(scene, poseAt(scene, 0)); };
    CHECK(wants(boxes({block}))); // its underside faces down
    CHECK(wants(boxes({block, narrow})));
    CHECK_FALSE(wants(boxes({block, floor})));
    CHECK_FALSE(wants(Scene()));
    const Bounds tower{glm::vec3(-0.5f, 0, -0.5f), glm::vec3(0.5f, 3, 0.5f)};
    CHECK(wants(boxes({tower, floor}))); // its shadow falls beyond the floor

    // Of any size, mirrored (which turns the winding of what is seen), or lifted by its node.
    for (const float scale : {0.003f, 500.0f, -1.0f}) {
        Scene scene = boxes({block, floor});
        for (Node& node : scene.nodes) node.scale = {scale, std::abs(scale), std::abs(scale)};
        CHECK_FALSE(wants(scene));
    }
    Scene flying = boxes({block, floor});
    flying.nodes[1].translation.y = 3;
    CHECK(wants(flying));
}

TEST_CASE("a scene's camera is taken as it stands") {
    Scene scene = boxes({{glm::vec3(-1), glm::vec3(1)}});
    Node node;
    node.translation = {0, 0, 5};
    scene.nodes.push_back(node);
    scene.cameras.push_back({.name = "front", .node = 1, .fovY = 60});
    Camera camera = defaultCamera(scene, poseAt(scene, 0));
    CHECK(camera.eye == glm::vec3(0, 0, 5));
    CHECK(glm::distance(camera.target, glm::vec3(0, 0, 1)) < 1e-5f); // turns about the surface that it looks at
    CHECK(camera.up == glm::vec3(0, 1, 0));
    CHECK(camera.fovY == 60);

    scene.nodes[1].translation = {0, 3, 5}; // looks over the box: about the depth of the scene's centre
    camera = defaultCamera(scene, poseAt(scene, 0));
    CHECK(glm::distance(camera.target, glm::vec3(0, 3, 0)) < 1e-5f);
    scene.nodes[1].translation = {0, 0, 5};

    scene.nodes[1].rotation = glm::angleAxis(glm::radians(30.0f), glm::vec3(0, 0, 1));
    camera = defaultCamera(scene, poseAt(scene, 0));
    CHECK(glm::distance(camera.up, glm::vec3(-0.5f, std::sqrt(0.75f), 0)) < 1e-5f);

    // An orthographic one shows as much of the plane through the centre.
    scene.cameras[0].halfHeight = 1.5f;
    camera = defaultCamera(scene, poseAt(scene, 0));
    const float shown = glm::distance(camera.eye, camera.target) * std::tan(0.5f * glm::radians(camera.fovY));
    CHECK(shown == Approx(1.5f));
    CHECK(glm::distance(camera.target, glm::vec3(0)) < 1e-5f);
}

TEST_CASE("pixel rays and the clip matrix agree") {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    const Camera camera{.eye = {3, 2, 5}, .target = {0, 1, -1}, .fovY = 50};
    const View view = makeView(camera, {640, 360}, 0.5f, 50);
    CHECK(view.tanHalfFovY == Approx(std::tan(glm::radians(25.0f))));
    for (int i = 0; i < 100; ++i) {
        const glm::vec2 pixel(640 * unit(random), 360 * unit(random));
        const float depth = 0.5f + 49.5f * unit(random);
        const glm::vec3 world = view.eyeWorld + depth * (view.rayCorner + pixel.x * view.rayDx + pixel.y * view.rayDy);
        CHECK((view.eyeFromWorld * glm::vec4(world, 1)).z == Approx(-depth).epsilon(1e-4));
        const glm::vec4 clip = view.clipFromWorld * glm::vec4(world, 1);
        CHECK((0.5f * clip.x / clip.w + 0.5f) * 640 == Approx(pixel.x).margin(1e-2));
        CHECK((0.5f * clip.y / clip.w + 0.5f) * 360 == Approx(pixel.y).margin(1e-2));
    }
    const auto ndcDepth = [&](float depth) {
        const glm::vec4 clip =
            view.clipFromWorld * glm::vec4(view.eyeWorld + depth * glm::normalize(camera.target - camera.eye), 1);
        return clip.z / clip.w;
    };
    CHECK(ndcDepth(0.5f) == Approx(1).epsilon(1e-4));
    CHECK(ndcDepth(50) == Approx(0).margin(1e-6));
}

TEST_CASE("a camera without a direction or with its up along its sight still looks") {
    for (const Camera& camera :
         {Camera{.eye = {1, 1, 1}, .target = {1, 1, 1}}, Camera{.eye = {0, 5, 0}, .target = {0, 0, 0}, .up = {0, 1, 0}},
          Camera{.eye = {0, 0, 5}, .target = {0, 0, 0}, .up = {0, 0, 1}}}) {
        const glm::mat3 rotation(eyeFromWorld(camera));
        CHECK(glm::determinant(rotation) == Approx(1));
    }
}
