// SPDX-License-Identifier: MIT
// The structs that host and shaders share, as C++ sees them.
#pragma once

#include <glm/glm.hpp>

namespace penumbra {

using glm::mat4;
using glm::vec2;
using glm::vec4;

#include "shaders/shared/view.glsl.h"

static_assert(sizeof(ViewBlock) == 144 && sizeof(LightViewBlock) == 192);

} // namespace penumbra
