// SPDX-License-Identifier: MIT
#include "renderer/scene_loader.h"

#include <epoxy/gl.h>

namespace penumbra {

void SceneLoader::start(const std::filesystem::path& file, const ImportChoice& choice) {
    work_.start([this, file, choice](Progress& progress) {
        OpenedScene opened(std::make_shared<const Scene>(importGltf(file, choice, &progress)));
        progress.report("sending it to the GPU", 1);
        const SideContext::Use current(context_);
        LoadedScene loaded{opened, PreparedScene(opened.scene, &progress)};
        glFinish(); // the other context may use it from now on
        return loaded;
    });
}

} // namespace penumbra
