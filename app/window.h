// SPDX-License-Identifier: MIT
// The window: the viewport and the panels round it.
#pragma once

#include "renderer/session.h"

namespace penumbra {

// Shows the session in a window of this size until it is closed; returns the program's exit code. Throws InputError if
// there is no display or no OpenGL 4.5.
int runWindow(Session& session, glm::ivec2 size);

} // namespace penumbra
