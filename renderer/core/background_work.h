// SPDX-License-Identifier: MIT
// Long work on a thread of its own, whose result is fetched when it is there.
#pragma once

#include "renderer/core/progress.h"

#include <exception>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace penumbra {

template <class Result> class BackgroundWork {
public:
    BackgroundWork() = default;
    BackgroundWork(const BackgroundWork&) = delete;
    BackgroundWork& operator=(const BackgroundWork&) = delete;
    ~BackgroundWork() {
        drop();
        for (const auto& task : dropped_) task->thread.join();
    }

    // Begins with Result work(Progress&); what still runs is dropped.
    template <class Work> void start(Work work) {
        drop();
        task_ = std::make_unique<Task>();
        task_->thread = std::thread([&task = *task_, work = std::move(work)]() mutable { task.run(work); });
    }
    // Asks it to end and wants nothing of it any more.
    void drop() {
        if (!task_) return;
        task_->progress.cancel();
        dropped_.push_back(std::move(task_));
    }
    // Asks it to end with what it has, which poll() brings.
    void stop() {
        if (task_) task_->progress.cancel();
    }
    // Of the work that is done; null when none is.
    const Progress* progress() const { return task_ ? &task_->progress : nullptr; }
    // The result once it is there. Throws what the work threw; of one that ended by throwing Cancelled there is none.
    std::optional<Result> poll() {
        std::erase_if(dropped_, [](const std::unique_ptr<Task>& task) {
            if (task->done) task->thread.join();
            return task->done.load();
        });
        if (!task_ || !task_->done) return std::nullopt;
        const std::unique_ptr<Task> task = std::move(task_);
        task->thread.join();
        if (task->failure) std::rethrow_exception(task->failure);
        return std::move(task->result);
    }

private:
    struct Task {
        Progress progress;
        std::optional<Result> result;
        std::exception_ptr failure;
        std::atomic<bool> done{false};
        std::thread thread;

        template <class Work> void run(Work& work) {
            try {
                result.emplace(work(progress));
            } catch (const Cancelled&) {
            } catch (...) {
                failure = std::current_exception();
            }
            done = true;
        }
    };

    std::unique_ptr<Task> task_;
    std::vector<std::unique_ptr<Task>> dropped_; // and not yet at their end
};

} // namespace penumbra
