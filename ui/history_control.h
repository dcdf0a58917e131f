// SPDX-License-Identifier: MIT
// Whether a technique's history goes on from frame to frame: frozen, one frame at a time, or up to a number of frames.
// What is frozen is drawn again where anything else changes, and reads the same past each time.
#pragma once

#include "renderer/core/flow.h"

#include <optional>

namespace penumbra {

class HistoryControl {
public:
    static constexpr int mostFrames = 9999;
    int target = 16; // frames that runToTarget() goes up to

    bool frozen() const { return frozen_; } // and not on its way to somewhere
    bool counting() const { return steps_ > 0 || until_; }
    void freeze(bool on) {
        frozen_ = on;
        steps_ = 0;
        until_.reset();
    }
    // One frame more, and no further.
    void step() {
        if (!frozen_) return freeze(true);
        until_.reset();
        ++steps_;
    }
    // Until the history is of `target` frames, and no further. True: it is already, and must be forgotten first.
    bool runToTarget(int length) {
        freeze(true);
        until_ = target;
        return length >= target;
    }

    Turn next() const { return frozen_ && !counting() ? Turn::Again : Turn::Next; } // of the next frame
    // A frame is finished, of a history of that length; 0: there is none, and nothing to hold still.
    void finished(Turn turn, int length) {
        if (length == 0) return freeze(false);
        if (turn == Turn::Next && steps_ > 0) --steps_;
        if (until_ && length >= *until_) until_.reset();
    }

private:
    bool frozen_ = false;
    int steps_ = 0;
    std::optional<int> until_;
};

} // namespace penumbra
