// SPDX-License-Identifier: MIT
#include "ui/colours.h"

#include "renderer/shared.h"

namespace penumbra {

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function" // what only the GPU calls
namespace glsl {
using glm::abs;
using glm::floor;
using glm::fract;
using glm::max;
using glm::min;
using glm::pow;
using glm::vec3;
#include "shaders/lib/srgb.glsl"

#include "shaders/lib/colour_map.glsl" // needs the one above
} // namespace glsl
#pragma GCC diagnostic pop

ImU32 ink(glm::vec3 c) { return ImGui::GetColorU32(ImVec4(c.r, c.g, c.b, 1)); }

} // namespace

ImU32 divergingColour(float t) { return ink(glsl::diverging(t)); }
ImU32 flagColour(int number) { return ink(glsl::flagColour(static_cast<float>(number))); }

} // namespace penumbra
