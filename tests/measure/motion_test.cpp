// SPDX-License-Identifier: MIT
#include "renderer/measure/motion.h"
#include "tests/catch.h"

#include <glm/gtc/constants.hpp>

#include <vector>

using namespace penumbra;

TEST_CASE("before its event a motion changes nothing but the time that a caster stops at") {
    const Rest start;
    for (size_t i = 0; i < motionNames().size(); ++i) {
        const auto motion = MotionEvent(i);
        Session s;
        place(motion, start, eventFrame - 1, s);
        CAPTURE(motionNames()[i]);
        CHECK(s.camera.eye == start.camera.eye);
        CHECK(glm::distance(s.camera.target, start.camera.target) < 1e-6f);
        CHECK(s.light == start.light);
        CHECK(s.time == Approx(motion == MotionEvent::CasterStops ? (eventFrame - 1) * motionStep : 0.0));
        place(motion, start, eventFrame, s);
        const bool differs = s.camera.eye != start.camera.eye || s.camera.target != start.camera.target ||
                             !(s.light == start.light) || s.time != start.time;
        CHECK(differs);
    }
}

TEST_CASE("a pan turns by a pixel a frame, a jump keeps its distance, a light comes to rest") {
    const Rest start;
    Session s;
    s.size = {320, 240};
    place(MotionEvent::CameraPan, start, eventFrame + 9, s);
    const glm::vec3 before = glm::normalize(start.camera.target - start.camera.eye),
                    after = glm::normalize(s.camera.target - s.camera.eye);
    const float level = glm::length(glm::vec2(before.x, before.z));
    const float pixel = 2 * std::tan(glm::radians(0.5f * start.camera.fovY)) / 240;
    CHECK(glm::distance(before, after) == Approx(10 * pixel * level).epsilon(0.01));

    place(MotionEvent::CameraJump, start, eventFrame, s);
    CHECK(glm::distance(s.camera.eye, s.camera.target) == Approx(glm::distance(start.camera.eye, start.camera.target)));

    place(MotionEvent::LightMoves, start, eventFrame + 20, s);
    const AreaLight rest = s.light;
    place(MotionEvent::LightMoves, start, eventFrame + 40, s);
    CHECK(s.light == rest);
    CHECK(glm::distance(rest.position, start.light.position) ==
          Approx(0.16f * glm::distance(start.light.position, start.light.target)));

    place(MotionEvent::LightGrows, start, eventFrame + 40, s);
    CHECK(s.light.size.x == Approx(start.light.size.x * std::pow(1.05f, 8.0f)));
    place(MotionEvent::CasterStops, start, 50, s);
    CHECK(s.time == Approx((eventFrame - 1) * motionStep));
}

TEST_CASE("a ghost's half-life is counted from the peak to half way down to where it settles") {
    // 0.01 + 0.16 / 2^i after a rise
    std::vector<double> errors{0.05};
    for (int i = 0; i < 40; ++i) errors.push_back(0.01 + 0.16 / std::pow(2.0, i / 3.0));
    const Ghost ghost = ghostOf(errors);
    CHECK(ghost.peak == Approx(0.17));
    CHECK(ghost.settled == Approx(0.01).margin(1e-4));
    CHECK(ghost.halfLife == 3);
    CHECK_FALSE(ghostOf({}).halfLife);
    CHECK_FALSE(ghostOf(std::vector<double>(8, 0.02)).halfLife);
    CHECK_FALSE(ghostOf(std::vector<double>{0.0201, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02}).halfLife);
    CHECK_FALSE(ghostOf(std::vector<double>{0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.1}).halfLife); // still rising
}
