// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "ui/navigation.h"

#include <glm/gtx/string_cast.hpp>

using namespace penumbra;

namespace {

float distance(const Camera& camera) { return glm::length(camera.target - camera.eye); }

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

TEST_CASE("orbiting keeps the distance and never passes over the pole") {
    for (const float scale : {0.006f, 1.0f, 2000.0f}) {
        Camera camera;
        camera.eye = scale * glm::vec3(1, 2, 3);
        camera.target = scale * glm::vec3(0.5f, 0, 0);
        const float start = distance(camera);
        for (int i = 0; i < 400; ++i) {
            orbit(camera, 3, 5);
            REQUIRE(finite(camera.eye));
            CHECK(distance(camera) == Approx(start).epsilon(1e-3));
        }
        const glm::vec3 backward = (camera.eye - camera.target) / distance(camera);
        CHECK(backward.y < 1);
        CHECK(backward.y > 0.999f);
        CHECK(glm::length(glm::vec2(backward.x, backward.z)) > 1e-4f); // still has a side to turn to
        orbit(camera, 0, -90);
        CHECK(glm::dot(glm::normalize(camera.eye - camera.target), camera.up) == Approx(0).margin(0.01));
    }
}

TEST_CASE("orbiting right moves the eye to the right hand") {
    Camera camera;
    camera.eye = {0, 0, 5};
    camera.target = {0, 0, 0};
    orbit(camera, 90, 0);
    CHECK(camera.eye.x == Approx(5));
    CHECK(camera.eye.z == Approx(0).margin(1e-5));
    orbit(camera, 0, 45);
    CHECK(camera.eye.y == Approx(5 * std::sqrt(0.5f)));
}

TEST_CASE("panning moves the scene with the pointer") {
    Camera camera;
    camera.eye = {0, 0, 5};
    camera.target = {0, 0, 0};
    const View before = makeView(camera, {800, 600}, 0.1f, 100);
    pan(camera, {30, 20}, 600); // right and down
    const View after = makeView(camera, {800, 600}, 0.1f, 100);
    const auto pixel = [](const View& view) {
        const glm::vec4 clip = view.clipFromWorld * glm::vec4(0, 0, 0, 1);
        return glm::vec2(clip) / clip.w * glm::vec2(400, 300);
    };
    const glm::vec2 moved = pixel(after) - pixel(before);
    CHECK(moved.x == Approx(30).epsilon(1e-4));
    CHECK(moved.y == Approx(-20).epsilon(1e-4)); // OpenGL counts upwards
}

TEST_CASE("zooming stays between a thousandth and a hundred scene sizes") {
    for (const float size : {0.006f, 2000.0f}) {
        Camera camera;
        camera.eye = {0, 0, size};
        camera.target = {0, 0, 0};
        zoom(camera, 500, size);
        CHECK(distance(camera) == Approx(1e-3f * size));
        zoom(camera, -1000, size);
        CHECK(distance(camera) == Approx(100 * size));
    }
}

TEST_CASE("framing shows the whole of the bounds and keeps the direction") {
    Bounds bounds;
    bounds.add({1, 2, 3});
    bounds.add({4, 2.5f, 9});
    for (const glm::ivec2 pixels : {glm::ivec2(900, 300), glm::ivec2(300, 900)}) {
        Camera camera;
        const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
        frameBounds(camera, bounds, static_cast<float>(pixels.x) / static_cast<float>(pixels.y));
        CHECK(glm::distance(glm::normalize(camera.target - camera.eye), forward) < 1e-5f);
        const View view = makeView(camera, pixels, 0.1f, 100);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                              corner & 4 ? bounds.max.z : bounds.min.z);
            const glm::vec4 clip = view.clipFromWorld * glm::vec4(p, 1);
            CAPTURE(pixels.x, corner);
            CHECK(std::abs(clip.x) <= clip.w * 1.001f);
            CHECK(std::abs(clip.y) <= clip.w * 1.001f);
        }
    }
}

TEST_CASE("the light's azimuth, elevation and distance read back as they were set") {
    AreaLight light;
    light.target = {1, 2, 3};
    for (float azimuth = -175; azimuth <= 175; azimuth += 35)
        for (float elevation = -80; elevation <= 80; elevation += 40) {
            setLightDirection(light, {azimuth, elevation, 7});
            const LightDirection read = lightDirection(light);
            CAPTURE(azimuth, elevation);
            CHECK(read.azimuth == Approx(azimuth).margin(0.01));
            CHECK(read.elevation == Approx(elevation).margin(0.01));
            CHECK(read.distance == Approx(7));
        }
}

TEST_CASE("a light straight above can be turned and comes back") {
    AreaLight light;
    light.position = {0, 4, 0};
    light.target = {0, 0, 0};
    orbitLight(light, 10, 0);
    CHECK(finite(light.position));
    CHECK(light.position.y == Approx(4).epsilon(1e-4));
    orbitLight(light, 0, -45);
    CHECK(light.position.y < 3);
    CHECK(glm::length(light.position) == Approx(4).epsilon(1e-4));
}

TEST_CASE("a light comes nearer to its target and goes away, within a hundred scene sizes") {
    AreaLight light;
    light.position = {1, 4, 2};
    const float start = lightDirection(light).distance;
    moveLight(light, 1, 10);
    CHECK(lightDirection(light).distance == Approx(0.85f * start));
    moveLight(light, -1000, 10);
    CHECK(lightDirection(light).distance == Approx(1000));
}

TEST_CASE("scaling a light keeps its size within the limits and a directional light below a half circle") {
    AreaLight light;
    light.size = {2, 3};
    scaleLight(light, {2, 0.5f});
    CHECK(light.size == glm::vec2(4, 1.5f));
    for (int i = 0; i < 200; ++i) scaleLight(light, glm::vec2(2));
    CHECK(light.size == glm::vec2(static_cast<float>(limits::lightMetres.max)));
    for (int i = 0; i < 200; ++i) scaleLight(light, glm::vec2(0.5f));
    CHECK(light.size == glm::vec2(static_cast<float>(limits::lightMetres.min)));

    light.shape = LightShape::Directional;
    light.size = glm::vec2(40);
    scaleLight(light, glm::vec2(2));
    CHECK(light.size.x == Approx(2 * glm::degrees(std::atan(2 * std::tan(glm::radians(20.0f))))));
    for (int i = 0; i < 50; ++i) scaleLight(light, glm::vec2(2));
    CHECK(light.size.x == Approx(limits::lightDegrees.max));
}

TEST_CASE("a motion moves the camera or, as the camera sees it, the light") {
    Camera camera;
    camera.eye = {0, 0, 5};
    camera.target = {0, 0, 0};
    const Camera before = camera;
    move(camera, {}, 600, 10);
    CHECK(camera == before);
    Motion motion;
    motion.fly = {1, 2, 3};
    move(camera, motion, 600, 10);
    CHECK(glm::distance(camera.eye, glm::vec3(1, 2, 2)) < 1e-5f);
    CHECK(glm::distance(camera.target, glm::vec3(1, 2, -3)) < 1e-5f);

    AreaLight light;
    light.position = {0, 2, 0};
    light.target = {0, 0, 0};
    move(light, before, motion, 600, 10);
    CHECK(glm::distance(light.position, glm::vec3(1, 4, -3)) < 1e-5f);
    CHECK(light.target == glm::vec3(0));

    // Shifted with its target as far as the pointer went at the target's depth.
    motion = {};
    motion.pan = {30, 20};
    const AreaLight unshifted = light;
    move(light, before, motion, 600, 10);
    const View view = makeView(before, {600, 600}, 0.1f, 100);
    const glm::vec4 clip = view.clipFromWorld * glm::vec4(light.target, 1);
    CHECK(clip.x / clip.w * 300 == Approx(30).epsilon(1e-4));
    CHECK(clip.y / clip.w * 300 == Approx(-20).epsilon(1e-4));
    CHECK(glm::distance(light.position - unshifted.position, light.target) < 1e-5f);
}

TEST_CASE("nothing is put to where it looks") {
    AreaLight light;
    const glm::vec3 before = light.position;
    put(light.position, light.target, light.target, 10);
    CHECK(light.position == before);
    put(light.position, {1, 1, 1}, light.target, 10);
    CHECK(light.position == glm::vec3(1));
}

TEST_CASE("the speed of flight stays between a thousandth of the scene and ten scenes a second") {
    ViewSettings settings;
    settings.changeSpeed(1);
    CHECK(settings.flySpeed == Approx(0.25f));
    settings.changeSpeed(1000);
    CHECK(settings.flySpeed == Approx(10));
    settings.changeSpeed(-1000);
    CHECK(settings.flySpeed == Approx(0.001f));
}
