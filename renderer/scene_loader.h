// SPDX-License-Identifier: MIT
// Loads a scene on a thread of its own, from the file to the GPU, while the window goes on.
#pragma once

#include "renderer/core/background_work.h"
#include "renderer/gl/side_context.h"
#include "renderer/renderer.h"

#include <optional>

namespace penumbra {

struct LoadedScene {
    OpenedScene opened;
    PreparedScene prepared;
};

class SceneLoader {
public:
    // With a context that shares objects with the renderer's.
    explicit SceneLoader(SideContext::MakeCurrent makeCurrent) : context_(std::move(makeCurrent)) {}

    // Begins with another scene; one that is still loading is cancelled.
    void start(const std::filesystem::path& file, const ImportChoice& choice);
    void cancel() { work_.drop(); }
    // Of the scene that is loading; null when none is.
    const Progress* progress() const { return work_.progress(); }
    // The scene once it is there. Throws what the import threw. Call it with the renderer's context, every frame.
    std::optional<LoadedScene> poll() { return work_.poll(); }

private:
    SideContext context_;
    BackgroundWork<LoadedScene> work_; // last: it ends before the context does
};

} // namespace penumbra
