// SPDX-License-Identifier: MIT
#include "ui/numbers.h"

#include "ui/navigation.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

void pointRow(const char* label, const char* id, const char* help, glm::vec3& point, glm::vec3 other, float sceneSize) {
    row(label);
    glm::vec3 edited = point;
    const float limit = static_cast<float>(limits::coordinate.max);
    const bool changed = ImGui::DragFloat3(id, &edited.x, 0.002f * sceneSize, -limit, limit,
                                           metreFormat(sceneSize).begin(), ImGuiSliderFlags_AlwaysClamp);
    tooltip(ShortText("{}: x, y, z in metres. Drag, or Ctrl+click to type.", help).view());
    if (changed && std::isfinite(edited.x) && std::isfinite(edited.y) && std::isfinite(edited.z))
        put(point, edited, other, sceneSize);
}

} // namespace

ShortText metreFormat(float sceneSize) {
    const int digits = std::clamp(3 - static_cast<int>(std::floor(std::log10(sceneSize))), 0, 5);
    return ShortText("%.{}f", digits);
}

bool dragNumber(const char* id, float& value, float speed, Range limits, const char* format, ImGuiSliderFlags flags) {
    float edited = value;
    if (!ImGui::DragFloat(id, &edited, speed, static_cast<float>(limits.min), static_cast<float>(limits.max), format,
                          flags) ||
        !std::isfinite(edited))
        return false;
    value = edited;
    return true;
}

bool dragDecades(const char* id, float& value, Range limits, const char* format) {
    const float speed = 0.0005f * static_cast<float>(limits.max - limits.min); // ImGui divides by the range
    return dragNumber(id, value, speed, limits, format, ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
}

void pointRows(const char* placeLabel, const char* placeHelp, glm::vec3& place, const char* targetHelp,
               glm::vec3& target, float sceneSize) {
    pointRow(placeLabel, "##place", placeHelp, place, target, sceneSize);
    pointRow("Target  [m]", "##target", targetHelp, target, place, sceneSize);
}

} // namespace penumbra
