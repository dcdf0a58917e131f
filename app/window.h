// SPDX-License-Identifier: MIT
// The window: the viewport and the panels round it.
#pragma once

#include "renderer/session.h"

#include <filesystem>

namespace penumbra {

struct WindowOptions {
    std::filesystem::path picturesFolder; // where pictures taken in the window go
    int width = 1280, height = 720;
};

// Shows the session until the window is closed; returns the program's exit code. Throws InputError if there is no
// display or no OpenGL 4.5.
int runWindow(Session& session, const WindowOptions& options);

} // namespace penumbra
