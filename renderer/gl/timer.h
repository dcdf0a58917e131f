// SPDX-License-Identifier: MIT
// Times the passes of a frame: with timer queries that never stall, or with glFinish and a steady clock, which is the
// only honest way on a renderer that defers its work (llvmpipe reports a fiftieth of what a raster pass takes).
#pragma once

#include "renderer/core/flow.h"
#include "renderer/gl/handle.h"

#include <array>
#include <chrono>
#include <vector>

namespace penumbra {

enum class Timing {
    Off,
    Queries, // GPU timer queries, read some frames later: never stalls
    Finish,  // glFinish around each pass and a steady clock
};

struct PassTime {
    Stage stage;
    int label; // of the flow
    double milliseconds;
};

// Times that have come in.
struct TimedFrame {
    uint64_t number = 0;            // from 1 on; 0: none yet
    double milliseconds = 0;        // from the first pass to the end of the last one, without what was somebody else's
    std::vector<PassTime> passes{}; // in their order; those of one label are summed
};

class PassTimer {
public:
    void beginFrame(Timing timing);
    // What has passed since the last call was somebody else's: the next pass, or more of the same, begins now.
    void resume();
    // Once or more a pass, for the work since the last call.
    void endPass(Stage stage, int label);
    void endFrame();
    // Takes in what timer queries have come in since; never stalls. beginFrame does so too.
    void poll();

    // The newest frame whose times are known.
    const TimedFrame& newest() const { return newest_; }
    // The number of the frame begun last.
    uint64_t frame() const { return frame_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Mark {
        Stage stage;
        int label; // −1: somebody else's time
    };
    // Timestamps of one frame under way: query 0 before the first pass, query i + 1 behind what mark i tells of.
    struct Round {
        std::vector<GLuint> queries;
        std::vector<Mark> marks;
        uint64_t frame = 0;
        bool pending = false;
        Round() = default;
        Round(const Round&) = delete;
        ~Round() { glDeleteQueries(static_cast<GLsizei>(queries.size()), queries.data()); }
    };
    void stamp(Round& round, size_t index);
    void collect(Round& round);
    void add(Stage stage, int label, double milliseconds);

    Timing timing_ = Timing::Off;
    uint64_t frame_ = 0;
    std::array<Round, 4> rounds_{};
    size_t round_ = 0;
    Clock::time_point frameStart_, passStart_;
    Clock::duration elsewhere_{};
    TimedFrame newest_;
};

} // namespace penumbra
