// SPDX-License-Identifier: MIT
#include "renderer/scene_loader.h"

#include <epoxy/gl.h>

namespace penumbra {

SceneLoader::~SceneLoader() {
    cancel();
    for (const auto& task : abandoned_) task->thread.join();
}

void SceneLoader::start(const std::filesystem::path& file, const ImportChoice& choice) {
    cancel();
    task_ = std::make_unique<Task>();
    task_->thread = std::thread([this, &task = *task_, file, choice] { run(task, file, choice); });
}

void SceneLoader::cancel() {
    if (!task_) return;
    task_->progress.cancel();
    abandoned_.push_back(std::move(task_));
}

std::optional<LoadedScene> SceneLoader::poll() {
    std::erase_if(abandoned_, [](const std::unique_ptr<Task>& task) {
        if (task->done) task->thread.join();
        return task->done.load();
    });
    if (!task_ || !task_->done) return std::nullopt;
    const std::unique_ptr<Task> task = std::move(task_);
    task->thread.join();
    if (task->failure) std::rethrow_exception(task->failure);
    return std::move(task->loaded);
}

void SceneLoader::run(Task& task, const std::filesystem::path& file, const ImportChoice& choice) {
    try {
        OpenedScene opened(std::make_shared<const Scene>(importGltf(file, choice, &task.progress)));
        task.progress.report("sending it to the GPU", 1);
        const std::lock_guard lock(context_);
        makeCurrent_(true);
        try {
            task.loaded.emplace(opened, PreparedScene(opened.scene, &task.progress));
            glFinish(); // the other context may use it from now on
        } catch (...) {
            task.failure = std::current_exception();
        }
        makeCurrent_(false);
    } catch (const Cancelled&) {
    } catch (...) {
        task.failure = std::current_exception();
    }
    task.done = true;
}

} // namespace penumbra
