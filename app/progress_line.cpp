// SPDX-License-Identifier: MIT
#include "app/progress_line.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

#include <unistd.h>

namespace penumbra {
namespace {

using namespace std::chrono_literals;

std::atomic<Progress*> running{nullptr}; // that Ctrl-C cancels
static_assert(std::atomic<Progress*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void cancelRunning(int) {
    if (Progress* progress = running) progress->cancel();
}

} // namespace

ProgressLine::ProgressLine() {
    running = &progress_;
    struct sigaction action = {};
    action.sa_handler = cancelRunning;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    thread_ = std::thread([this] { tell(); });
}

ProgressLine::~ProgressLine() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    running = nullptr;
    {
        const std::lock_guard lock(mutex_);
        end_ = true;
    }
    ended_.notify_one();
    thread_.join();
}

// On a terminal one line that is written over; else a line now and then.
void ProgressLine::tell() {
    const bool terminal = ::isatty(STDERR_FILENO) != 0;
    const auto pause = terminal ? 250ms : 10000ms;
    size_t width = 0;
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, pause, [&] { return end_; })) {
        std::string line = fmt::format("{}: {:.0f} %", progress_.doing(), 100 * progress_.share());
        if (progress_.cancelled()) line += ", ending";
        const size_t used = line.size();
        if (terminal) line.resize(std::max(width, used), ' ');
        width = used;
        fmt::print(stderr, "{}{}{}", terminal ? "\r" : "", line, terminal ? "" : "\n");
        std::fflush(stderr);
    }
    if (terminal && width > 0) {
        fmt::print(stderr, "\r{:{}}\r", "", width);
        std::fflush(stderr);
    }
}

} // namespace penumbra
