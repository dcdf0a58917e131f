// SPDX-License-Identifier: MIT
// Preloaded into the program: writes a line for each frame that a window shows, so that tests can wait for frames and
// know how long they took, without a hook in the program.
//
//     FRAME_LOG=FILE LD_PRELOAD=libframe-log.so penumbra
//
// Each line: milliseconds since the first frame, milliseconds of work (from the end of the wait for input to the end of
// the swap), and the same without the time that the thread was ready but had no processor, because of other programs.
#include <dlfcn.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

struct GLFWwindow;

namespace {

using Clock = std::chrono::steady_clock;
Clock::time_point workStart = Clock::now();
double readyStart = 0;

template <class Function> Function real(const char* name) { return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name)); }

// How long the thread has waited for a processor in its life [ms]; 0 where the kernel does not tell.
double ready() {
    std::FILE* const file = std::fopen("/proc/thread-self/schedstat", "r");
    if (!file) return 0;
    unsigned long long ran = 0, waited = 0;
    const bool told = std::fscanf(file, "%llu %llu", &ran, &waited) == 2;
    std::fclose(file);
    return told ? static_cast<double>(waited) * 1e-6 : 0;
}

void startWork() {
    workStart = Clock::now();
    readyStart = ready();
}

double milliseconds(Clock::duration duration) { return std::chrono::duration<double, std::milli>(duration).count(); }

} // namespace

extern "C" {

void glfwPollEvents() {
    static const auto poll = real<void (*)()>("glfwPollEvents");
    poll();
    startWork();
}

void glfwWaitEvents() {
    static const auto wait = real<void (*)()>("glfwWaitEvents");
    wait();
    startWork();
}

void glfwWaitEventsTimeout(double seconds) {
    static const auto wait = real<void (*)(double)>("glfwWaitEventsTimeout");
    wait(seconds);
    startWork();
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
    const double work = milliseconds(now - workStart);
    std::fprintf(log, "%.2f %.2f %.2f\n", milliseconds(now - first), work, work - (ready() - readyStart));
    std::fflush(log);
}
}
