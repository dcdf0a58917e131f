// SPDX-License-Identifier: MIT
#include "ui/widgets.h"

#include <algorithm>

namespace penumbra {

void text(std::string_view line) {
    // Without a pointer ImGui would look for the end of a string that is not there.
    if (line.empty()) line = "";
    ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

void text(ImVec4 colour, std::string_view line) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    text(line);
    ImGui::PopStyleColor();
}

void wrappedText(std::string_view paragraph) {
    ImGui::PushTextWrapPos(0);
    text(paragraph);
    ImGui::PopTextWrapPos();
}

void wrappedText(ImVec4 colour, std::string_view paragraph) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    wrappedText(paragraph);
    ImGui::PopStyleColor();
}

void rightText(std::string_view line) {
    const float width = ImGui::CalcTextSize(line.data(), line.data() + line.size()).x;
    const float slack = ImGui::GetContentRegionAvail().x - width;
    if (slack > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + slack);
    text(line);
}

ShortText bytesText(uint64_t bytes) {
    if (bytes < 1024) return ShortText("{} B", bytes);
    const double kibibytes = static_cast<double>(bytes) / 1024;
    if (kibibytes < 1024) return ShortText("{:.1f} KiB", kibibytes);
    if (kibibytes < 1024 * 1024) return ShortText("{:.1f} MiB", kibibytes / 1024);
    return ShortText("{:.2f} GiB", kibibytes / 1024 / 1024);
}

ShortText extentText(const Extent& extent) {
    if (extent.layers > 1) return ShortText("{} × {} × {}", extent.width, extent.height, extent.layers);
    return ShortText("{} × {}", extent.width, extent.height);
}

bool section(const char* title, bool openAtFirst) {
    return ImGui::CollapsingHeader(title, openAtFirst ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void subtitle(std::string_view title, float reserved) {
    ImGui::Spacing();
    if (reserved > 0) ImGui::AlignTextToFramePadding();
    text(colour::muted, title);
    const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
    const float y = (min.y + max.y) / 2, gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x - reserved;
    if (max.x + gap < right)
        ImGui::GetWindowDrawList()->AddLine({max.x + gap, y}, {right, y}, ImGui::GetColorU32(ImGuiCol_Separator));
}

void row(std::string_view label, float reserved) {
    const float width = ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x;
    const float column = ImGui::GetWindowContentRegionMin().x + 0.42f * width;
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(column - ImGui::GetStyle().ItemInnerSpacing.x);
    text(label);
    ImGui::PopTextWrapPos();
    ImGui::SameLine(column);
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - reserved, 1.0f));
}

bool progressWithCancel(const Progress& progress) {
    const float button = ImGui::CalcTextSize("Cancel").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::ProgressBar(static_cast<float>(progress.share()), {-button - ImGui::GetStyle().ItemSpacing.x, 0});
    ImGui::SameLine();
    ImGui::BeginDisabled(progress.cancelled());
    const bool pressed = ImGui::Button("Cancel");
    ImGui::EndDisabled();
    return pressed;
}

bool pointedAt() {
    return ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) && !ImGui::IsMouseDown(ImGuiMouseButton_Left);
}

void beginHelp() {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28);
}

void endHelp() {
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void tooltip(std::string_view paragraph) {
    if (!pointedAt()) return;
    beginHelp();
    text(paragraph);
    endHelp();
}

namespace {

// Right after Begin.
bool unlessEscaped(bool open) {
    if (open && !ImGui::IsAnyItemActive() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false))
        ImGui::CloseCurrentPopup();
    return open;
}

} // namespace

bool beginPopup(const char* id) { return unlessEscaped(ImGui::BeginPopup(id)); }

bool beginCombo(const char* id, const char* shown, ImGuiComboFlags flags) {
    return unlessEscaped(ImGui::BeginCombo(id, shown, flags));
}

bool toggleButton(const char* label, bool on) {
    if (on) ImGui::PushStyleColor(ImGuiCol_Text, colour::accent);
    const bool pressed = ImGui::Button(label);
    if (on) ImGui::PopStyleColor();
    return pressed;
}

} // namespace penumbra
