// SPDX-License-Identifier: MIT
// The structs that host and shaders share, as C++ sees them.
#pragma once

#include <glm/glm.hpp>

namespace penumbra {

using glm::ivec4;
using glm::mat4;
using glm::vec2;
using glm::vec4;
using uint = unsigned int;

#include "shaders/shared/inspect.glsl.h"
#include "shaders/shared/view.glsl.h"

static_assert(sizeof(ViewBlock) == 176 && sizeof(LightViewBlock) == 192);
static_assert(sizeof(SourceBlock) == 64 && sizeof(PaintBlock) == 112 && sizeof(MeasureBlock) == 96 &&
              sizeof(SampleBlock) == 80);

} // namespace penumbra
