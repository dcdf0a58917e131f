// SPDX-License-Identifier: MIT
// Measures and searches on a thread and in an OpenGL context of its own, while the window goes on.
#pragma once

#include "renderer/core/background_work.h"
#include "renderer/gl/side_context.h"
#include "renderer/measure/budget.h"

#include <memory>
#include <mutex>

namespace penumbra {

// What a session shows at this moment, as a still view of its own, by the studied light alone. Techniques have their
// defaults.
Session stillView(const Session& session);

class BackgroundMeasurement {
public:
    explicit BackgroundMeasurement(SideContext::MakeCurrent makeCurrent) : context_(std::move(makeCurrent)) {}

    // A quick look at each of the settings, then all of them side by side for longer. What still runs is dropped.
    void measure(Session view, std::vector<Setting> settings, TruthSettings truth);
    // Searches in one or several views.
    struct Question {
        std::vector<Setting> starts;
        std::vector<FreeParameter> free;
        Budget budget;
    };
    void search(std::vector<Session> views, Question question, TruthSettings truth);
    // What happens to settings, side by side, while the view moves for so many frames.
    void move(Session view, std::vector<Setting> settings, MotionEvent motion, int frames, TruthSettings truth);
    void stop() { work_.stop(); } // and keep what is done

    const Progress* progress() const { return work_.progress(); } // null: nothing runs
    // What was measured since the last call, of the work that was started last.
    std::vector<SettingResult> take();
    // Of move(), frames that were compared since the last call. `setting`: which of them, in their order.
    struct MovedFrame {
        size_t setting;
        int frame;
        double rmse, penumbraRmse;
    };
    std::vector<MovedFrame> takeFrames();
    // Once, when the work has ended; of a search, what it came to. Throws what it threw.
    struct End {
        std::optional<BudgetSearch> search;
        bool complete = true;
    };
    std::optional<End> poll() { return work_.poll(); }

private:
    struct Letterbox {
        std::mutex mutex;
        std::vector<SettingResult> results;
        std::vector<MovedFrame> frames;
        void put(SettingResult result) {
            const std::lock_guard lock(mutex);
            results.push_back(std::move(result));
        }
    };

    SideContext context_;
    std::shared_ptr<Letterbox> letterbox_; // of the work that was started last
    BackgroundWork<End> work_;             // last: it ends before the context does
};

} // namespace penumbra
