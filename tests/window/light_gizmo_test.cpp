// SPDX-License-Identifier: MIT
// The light taken by the hand: what lies under the pointer, and what a drag makes of it.
#include "tests/catch.h"

#include "ui/light_gizmo.h"

#include <cmath>

using namespace penumbra;

namespace {

constexpr float reach = 8, sceneSize = 10;

ScreenView screenFrom(glm::vec3 eye, glm::vec3 target = {0, 1, 0}) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    return {makeView(camera, {1600, 1200}, 0.01f, 100), {100, 50}, {800, 600}};
}

AreaLight lightOf(LightShape shape) {
    AreaLight light;
    light.shape = shape;
    light.position = {0.5f, 2, 1};
    light.target = {0.2f, 0, -0.5f};
    light.size = shape == LightShape::Directional ? glm::vec2(20) : glm::vec2(1.2f, 0.7f);
    return light;
}

constexpr LightShape shapes[] = {LightShape::Rectangle, LightShape::Disk, LightShape::Directional};

glm::vec3 edgePoint(const AreaLight& light, LightHandle handle) { // in the middle of an edge
    const LightOutline outline = lightOutline(light);
    for (size_t i = 0; i < outline.size(); ++i)
        if (edgeAt(light, i) == handle) return 0.5f * (outline[i] + outline[(i + 1) % outline.size()]);
    FAIL("no such edge");
    return {};
}

} // namespace

TEST_CASE("a ray through a point's place on the screen meets the point") {
    const ScreenView screen = screenFrom({3, 4, 6});
    for (const glm::vec3 world : {glm::vec3(0, 1, 0), glm::vec3(1, -0.5f, 2), glm::vec3(-2, 0.3f, -7)}) {
        const auto place = screen.project(world);
        REQUIRE(place);
        CHECK(glm::distance(screen.view.eyeWorld + screen.depth(world) * screen.ray(*place), world) < 1e-4f);
    }
    CHECK_FALSE(screen.project(glm::vec3(3, 4, 9)));         // behind the eye
    const auto line = screen.project({0, 1, 0}, {6, 7, 12}); // runs past the eye
    REQUIRE(line);
    CHECK(std::isfinite(line->second.x));
    CHECK_FALSE(screen.project(glm::vec3(6, 7, 12), glm::vec3(7, 7, 12)));
}

TEST_CASE("the pointer finds centre, target and edges of a light") {
    const ScreenView screen = screenFrom({3, 4, 6});
    for (const LightShape shape : shapes) {
        const AreaLight light = lightOf(shape);
        CAPTURE(int(shape));
        const auto handle = [&](glm::vec3 world) { return handleAt(light, screen, *screen.project(world), reach); };
        CHECK(handle(light.position) == LightHandle::Centre);
        CHECK(handle(light.target) == LightHandle::Target);
        CHECK(handle(edgePoint(light, LightHandle::Width)) == LightHandle::Width);
        if (shape == LightShape::Rectangle) CHECK(handle(edgePoint(light, LightHandle::Height)) == LightHandle::Height);
        CHECK(handleAt(light, screen, {110, 60}, reach) == LightHandle::None);
    }
}

TEST_CASE("what is dragged stays under the pointer") {
    const ScreenView screen = screenFrom({3, 4, 6});
    for (const LightShape shape : shapes)
        for (const LightHandle handle : {LightHandle::Centre, LightHandle::Target}) {
            AreaLight light = lightOf(shape);
            glm::vec3& point = handle == LightHandle::Centre ? light.position : light.target;
            const glm::vec2 from = *screen.project(point), to = from + glm::vec2(40, -25);
            dragHandle(light, handle, screen, from, to, false, sceneSize);
            CHECK(glm::distance(*screen.project(point), to) < 0.01f);
            CHECK(light.size == lightOf(shape).size);
        }
}

TEST_CASE("an edge that is dragged stays under the pointer and moves nothing else") {
    const ScreenView screen = screenFrom({1, 5, 4}); // looks at the light's face from above
    for (const LightShape shape : shapes)
        for (const LightHandle handle : {LightHandle::Width, LightHandle::Height}) {
            if (shape != LightShape::Rectangle && handle == LightHandle::Height) continue;
            AreaLight light = lightOf(shape);
            const AreaLight before = light;
            const glm::vec3 edge = edgePoint(light, handle);
            const glm::vec2 from = *screen.project(edge);
            const glm::vec2 to = *screen.project(light.position + 1.5f * (edge - light.position));
            dragHandle(light, handle, screen, from, to, false, sceneSize);
            CAPTURE(int(shape), int(handle));
            CHECK(glm::distance(*screen.project(edgePoint(light, handle)), to) < 0.5f);
            CHECK(light.position == before.position);
            CHECK(light.target == before.target);
            if (shape == LightShape::Rectangle) {
                const int other = handle == LightHandle::Width ? 1 : 0;
                CHECK(light.size[other] == before.size[other]);
            }
            // And back again.
            dragHandle(light, handle, screen, to, from, false, sceneSize);
            CHECK(light.size.x == Approx(before.size.x).epsilon(1e-3));
            dragHandle(light, handle, screen, from, to, true, sceneSize);
            CHECK(light.size.x / light.size.y == Approx(before.size.x / before.size.y).epsilon(1e-3));
        }
}

TEST_CASE("no drag makes a light that cannot be drawn") {
    for (const LightShape shape : shapes)
        for (const glm::vec3 eye : {glm::vec3(3, 4, 6), glm::vec3(0.5f, 2, 1.001f), glm::vec3(0.5f, 9, 1)})
            for (const LightHandle handle :
                 {LightHandle::Centre, LightHandle::Target, LightHandle::Width, LightHandle::Height}) {
                const ScreenView screen = screenFrom(eye);
                AreaLight light = lightOf(shape);
                glm::vec2 from(500, 350);
                for (int i = 0; i < 300; ++i) {
                    const glm::vec2 to = from + 90.0f * glm::vec2(std::sin(1.7f * float(i)), std::cos(2.9f * float(i)));
                    dragHandle(light, handle, screen, from, to, i % 3 == 0, sceneSize);
                    from = to;
                    const Range limits = shape == LightShape::Directional ? limits::lightDegrees : limits::lightMetres;
                    REQUIRE(light.size.x >= Approx(limits.min));
                    REQUIRE(light.size.x <= Approx(limits.max));
                    REQUIRE(glm::distance(light.position, light.target) > 0);
                    REQUIRE(std::isfinite(light.position.x + light.target.x));
                }
            }
}
