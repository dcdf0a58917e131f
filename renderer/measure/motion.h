// SPDX-License-Identifier: MIT
// Events that a technique with a memory must get over: a view rests, then something happens, frame by frame in a fixed
// step of time. How the error goes from there tells how long a ghost stays.
#pragma once

#include "renderer/session.h"

#include <optional>
#include <span>
#include <string_view>

namespace penumbra {

enum class MotionEvent { CameraPan, CameraJump, CasterMoves, CasterStops, LightMoves, LightGrows };
std::span<const std::string_view> motionNames(); // "camera-pan" ...

inline constexpr int eventFrame = 16;          // the first frame that differs
inline constexpr int motionFrames = 64;        // of a measurement, unless told otherwise
inline constexpr double motionStep = 1 / 60.0; // [s]

// Whether animated things move in some of the frames.
constexpr bool movesCasters(MotionEvent motion) {
    return motion == MotionEvent::CasterMoves || motion == MotionEvent::CasterStops;
}

// What a session looks like before anything happens.
struct Rest {
    Camera camera;
    AreaLight light;
    double time = 0;
};
// Gives `session` the camera, light and time of a frame.
void place(MotionEvent motion, const Rest& start, int frame, Session& session);

// What errors, one a frame from the event on, say.
struct Ghost {
    double peak = 0;    // the largest
    double settled = 0; // mean of the last quarter
    // Frames from the peak until the error is half way from there to `settled`; none where they hardly differ or the
    // peak comes so late that the half is not reached.
    std::optional<int> halfLife;
};
Ghost ghostOf(std::span<const double> errors);

} // namespace penumbra
