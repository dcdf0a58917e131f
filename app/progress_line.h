// SPDX-License-Identifier: MIT
// Tells on stderr how far long work is, from a thread of its own, and lets Ctrl-C end it.
#pragma once

#include "renderer/core/progress.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace penumbra {

class ProgressLine {
public:
    ProgressLine(); // one at a time
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    Progress& progress() { return progress_; } // cancelled by the first Ctrl-C; the second one ends the program

private:
    void tell();

    Progress progress_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool end_ = false;
    std::thread thread_;
};

} // namespace penumbra
