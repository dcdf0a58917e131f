// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <utility>

namespace penumbra {

// A context for threads beside the one that draws the window, one at a time.
class SideContext {
public:
    // Makes it current on the calling thread, or none.
    using MakeCurrent = std::function<void(bool)>;
    explicit SideContext(MakeCurrent makeCurrent) : makeCurrent_(std::move(makeCurrent)) {}

    // Current on this thread as long as it lives; waits for its turn.
    class Use {
    public:
        explicit Use(SideContext& context) : context_(context), turn_(context.mutex_) { context_.makeCurrent_(true); }
        ~Use() { context_.makeCurrent_(false); }
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

    private:
        SideContext& context_;
        std::lock_guard<std::mutex> turn_;
    };

private:
    MakeCurrent makeCurrent_;
    std::mutex mutex_;
};

} // namespace penumbra
