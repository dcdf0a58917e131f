// SPDX-License-Identifier: MIT
// What a window shows beside the truth: ψ* is traced in the background while the frames go on, ψ is read back now and
// then without a wait, and the errors of the one against the other are worked out on a thread.
#pragma once

#include "renderer/gl/read_back.h"
#include "renderer/measure/errors.h"
#include "renderer/session.h"

#include <array>
#include <chrono>
#include <future>

namespace penumbra {

// What was on screen: images of one frame, row 0 at the top.
struct Snapshot {
    View view;
    std::vector<float> depth;                 // eye depth [m], 0: no surface
    std::array<std::vector<float>, 2> shadow; // ψ of the technique, and of technique B or empty
};

// A truth as the pictures of a session show it, if that has the key.
std::shared_ptr<const TruthImage> imageOf(const Truth& truth, const TruthKey& key);

class Yardstick {
public:
    explicit Yardstick(TruthCache* cache = nullptr) : cache_(cache) {}
    ~Yardstick();
    Yardstick(const Yardstick&) = delete;

    bool truthWanted = false;     // trace it
    bool snapshotsWanted = false; // read ψ back even where there is no truth to hold it to

    // Once a frame, after `frames` have been rendered. `current`: the renderer's images are what the session says.
    // Starts what is due, takes what has come, and gives the session its truth.
    void update(Session& session, const Renderer& renderer, uint64_t frames, bool current);
    // Leaves it at what was traced so far, until the view changes.
    void cancel();
    // Goes on after cancel().
    void resume() { cancelled_ = false; }

    // The newest truth of the session's view, perhaps still being refined, or null.
    const Truth* truth() const { return truth_.get(); }
    bool cancelled() const { return cancelled_; }
    BackgroundTruth::State tracing() const { return background_.state(); }
    // Of the technique and of technique B against the truth; none before they are known.
    const std::array<std::optional<Errors>, 2>& errors() const { return errors_; }
    const Snapshot* snapshot() const { return snapshot_.get(); }

private:
    using Clock = std::chrono::steady_clock;
    struct Measured {
        std::shared_ptr<const Snapshot> snapshot;
        std::shared_ptr<const Truth> truth;
        std::array<std::optional<Errors>, 2> errors;
    };
    void forget(Session& session);
    void trace(Session& session, const Renderer& renderer, bool current);
    void shoot(const Session& session, const Renderer& renderer, uint64_t frames, bool current);
    void measure();

    TruthCache* cache_;
    BackgroundTruth background_;
    std::optional<TruthKey> key_; // of the view that all of this is about
    Clock::time_point changed_;   // when it became that one
    bool started_ = false, cancelled_ = false;
    std::shared_ptr<const Truth> truth_;

    ReadBack depthBack_;
    std::array<ReadBack, 2> shadowBack_;
    std::shared_ptr<Snapshot> coming_; // whose images are on their way
    std::shared_ptr<const Snapshot> snapshot_;
    uint64_t snapshotFrame_ = 0;
    Clock::time_point snapshotTime_;

    std::future<Measured> measuring_;
    Measured measured_; // what was measured last
    std::array<std::optional<Errors>, 2> errors_;
};

} // namespace penumbra
