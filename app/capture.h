// SPDX-License-Identifier: MIT
// Pictures of sessions: `penumbra capture`, and what the window needs to save its own.
#pragma once

#include "app/image_file.h"
#include "renderer/renderer.h"

namespace penumbra {

struct Options;

// What a picture's file tells about itself: program, scene, technique, parameters, camera, light, time, size, driver.
Facts factsOf(const Session& session, const std::string& driver);

// The last frame as the window shows it, sRGB encoded RGB.
Picture displayPicture(const Renderer& renderer);

// `penumbra capture`.
void capture(const Options& options);

} // namespace penumbra
