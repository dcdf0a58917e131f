// SPDX-License-Identifier: MIT
// Rows of numbers that are dragged or typed.
#pragma once

#include "ui/scene_facts.h"
#include "ui/widgets.h"

namespace penumbra {

// A printf format that shows a thousandth of the scene's size.
ShortText metreFormat(float sceneSize);
// `speed` per pixel. Typed numbers that are out of the limits are brought back into them.
bool dragNumber(const char* id, float& value, float speed, Range limits, const char* format,
                ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp);
// A length or angle over many decades: 100 pixels are a twentieth of them.
bool dragDecades(const char* id, float& value, Range limits, const char* format);
// Rows for two points that must not meet: where a thing is and where it looks.
void pointRows(const char* placeLabel, const char* placeHelp, glm::vec3& place, const char* targetHelp,
               glm::vec3& target, float sceneSize);

} // namespace penumbra
