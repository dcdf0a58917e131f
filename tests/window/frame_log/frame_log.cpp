// SPDX-License-Identifier: MIT
// Preloaded into the program: writes a line for each frame that a window shows, so that tests can wait for frames and
// know how long they took, without a hook in the program.
//
//     FRAME_LOG=FILE LD_PRELOAD=libframe-log.so penumbra
//
// Each line: milliseconds since the first frame, milliseconds of work (from the end of the wait for input to the end of
// the swap).
#include <dlfcn.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

struct GLFWwindow;

namespace {

using Clock = std::chrono::steady_clock;
Clock::time_point workStart = Clock::now();

template <class Function> Function real(const char* name) { return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name)); }

double milliseconds(Clock::duration duration) { return std::chrono::duration<double, std::milli>(duration).count(); }

} // namespace

extern "C" {

void glfwPollEvents() {
    static const auto poll = real<void (*)()>("glfwPollEvents");
    poll();
    workStart = Clock::now();
}

void glfwWaitEvents() {
    static const auto wait = real<void (*)()>("glfwWaitEvents");
    wait();
    workStart = Clock::now();
}

void glfwWaitEventsTimeout(double seconds) {
    static const auto wait = real<void (*)(double)>("glfwWaitEventsTimeout");
    wait(seconds);
    workStart = Clock::now();
}

void glfwSwapBuffers(GLFWwindow* window) {
    static const auto swap = real<void (*)(GLFWwindow*)>("glfwSwapBuffers");
    static const Clock::time_point first = Clock::now();
    static std::FILE* const log = [] {
        const char* file = std::getenv("FRAME_LOG");
        return file ? std::fopen(file, "a") : nullptr;
    }();
    swap(window);
    const Clock::time_point now = Clock::now();
    if (!log) return;
    std::fprintf(log, "%.2f %.2f\n", milliseconds(now - first), milliseconds(now - workStart));
    std::fflush(log);
}
}
