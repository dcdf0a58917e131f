// SPDX-License-Identifier: MIT
// Loads a scene on a thread of its own, from the file to the GPU, while the window goes on.
#pragma once

#include "renderer/core/progress.h"
#include "renderer/renderer.h"

#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace penumbra {

struct LoadedScene {
    OpenedScene opened;
    PreparedScene prepared;
};

class SceneLoader {
public:
    // Makes a context that shares objects with the renderer's current on the calling thread, or none. Loading threads
    // call it, one at a time, with true and then with false.
    using MakeCurrent = std::function<void(bool)>;

    explicit SceneLoader(MakeCurrent makeCurrent) : makeCurrent_(std::move(makeCurrent)) {}
    ~SceneLoader();

    // Begins with another scene; one that is still loading is cancelled.
    void start(const std::filesystem::path& file, const ImportChoice& choice);
    void cancel();
    // Of the scene that is loading; null when none is.
    const Progress* progress() const { return task_ ? &task_->progress : nullptr; }
    // The scene once it is there. Throws what the import threw. Call it with the renderer's context, every frame.
    std::optional<LoadedScene> poll();

private:
    struct Task {
        Progress progress;
        std::optional<LoadedScene> loaded;
        std::exception_ptr failure;
        std::atomic<bool> done{false};
        std::thread thread;
    };
    void run(Task& task, const std::filesystem::path& file, const ImportChoice& choice);

    MakeCurrent makeCurrent_;
    std::mutex context_;
    std::unique_ptr<Task> task_;
    std::vector<std::unique_ptr<Task>> abandoned_; // cancelled, and not yet at their end
};

} // namespace penumbra
