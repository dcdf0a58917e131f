// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace penumbra {

// Thrown by long work that was asked to stop.
struct Cancelled {};

// What long work tells of itself and hears from whoever waits for it, on another thread. The work calls report() often.
class Progress {
public:
    // `doing` is a literal: "decoding pictures". Throws Cancelled.
    void report(const char* doing, double share) {
        doing_ = doing;
        share_ = share;
        if (cancelled_) throw Cancelled{};
    }
    // For threads that must not throw.
    void note(double share) { share_ = share; }
    void cancel() { cancelled_ = true; }

    const char* doing() const { return doing_; }
    double share() const { return share_; } // done, in [0, 1]
    bool cancelled() const { return cancelled_; }

private:
    std::atomic<const char*> doing_{""};
    std::atomic<double> share_{0};
    std::atomic<bool> cancelled_{false};
};

} // namespace penumbra
