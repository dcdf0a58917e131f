// SPDX-License-Identifier: MIT
#include "renderer/measure/motion.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra {
namespace {

constexpr int lightFrames = 8;       // a light moves or grows for so long
constexpr float jumpDegrees = 20;    // of the eye around the target
constexpr float lightShare = 0.02f;  // of its distance that a light moves by a frame
constexpr float lightGrowth = 1.05f; // a frame

// About the vertical, to the left.
glm::vec3 turned(glm::vec3 v, float radians) {
    return glm::vec3(glm::rotate(glm::mat4(1), radians, {0, 1, 0}) * glm::vec4(v, 0));
}

} // namespace

std::span<const std::string_view> motionNames() {
    static constexpr std::string_view names[] = {"camera-pan",   "camera-jump", "caster-moves",
                                                 "caster-stops", "light-moves", "light-grows"};
    return names;
}

void place(MotionEvent motion, const Rest& start, int frame, Session& session) {
    const int since = std::max(frame - eventFrame + 1, 0);
    session.camera = start.camera;
    session.light = start.light;
    session.time = start.time;
    Camera& camera = session.camera;
    switch (motion) {
    case MotionEvent::CameraPan: { // a pixel of the picture's middle a frame
        const float pixel = 2 * std::tan(glm::radians(0.5f * camera.fovY)) / float(session.size.y);
        camera.target = camera.eye + turned(camera.target - camera.eye, float(since) * std::atan(pixel));
        break;
    }
    case MotionEvent::CameraJump:
        if (since > 0) camera.eye = camera.target + turned(camera.eye - camera.target, glm::radians(jumpDegrees));
        break;
    case MotionEvent::CasterMoves: session.time += since * motionStep; break;
    case MotionEvent::CasterStops: session.time += std::min(frame, eventFrame - 1) * motionStep; break;
    case MotionEvent::LightMoves: {
        const glm::vec3 gaze = session.light.target - session.light.position;
        glm::vec3 aside = glm::cross(gaze, glm::vec3(0, 1, 0));
        if (glm::length(aside) <= 1e-6f * glm::length(gaze)) aside = glm::vec3(1, 0, 0);
        const float distance = lightShare * glm::length(gaze) * float(std::min(since, lightFrames));
        session.light.position += glm::normalize(aside) * distance;
        break;
    }
    case MotionEvent::LightGrows:
        session.light.size *= std::pow(lightGrowth, float(std::min(since, lightFrames)));
        break;
    }
}

Ghost ghostOf(std::span<const double> errors) {
    if (errors.empty()) return {};
    const size_t quarter = std::max<size_t>(errors.size() / 4, 1);
    const auto peak = std::max_element(errors.begin(), errors.end());
    Ghost ghost{
        *peak, std::accumulate(errors.end() - std::ptrdiff_t(quarter), errors.end(), 0.0) / double(quarter), {}};
    if (ghost.peak - ghost.settled < 0.05 * ghost.peak) return ghost; // there is nothing to get over
    const double half = 0.5 * (ghost.peak + ghost.settled);
    const auto there = std::find_if(peak, errors.end(), [&](double e) { return e <= half; });
    if (there != errors.end()) ghost.halfLife = int(there - peak);
    return ghost;
}

} // namespace penumbra
