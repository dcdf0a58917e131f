// SPDX-License-Identifier: MIT
// The few shapes that all panels are made of: a line of text, a row of label and control, a section.
#pragma once

#include "renderer/core/image.h"
#include "renderer/core/progress.h"
#include "ui/theme.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra {

// Text on the stack: what a frame prints costs no allocation. Cut at its end if it is too long.
class ShortText {
public:
    template <class... Args> explicit ShortText(fmt::format_string<Args...> format, Args&&... args) {
        end_ = fmt::format_to_n(text_, sizeof(text_) - 1, format, std::forward<Args>(args)...).out;
        *end_ = 0;
    }
    const char* begin() const { return text_; }
    const char* end() const { return end_; }
    std::string_view view() const { return {text_, static_cast<size_t>(end_ - text_)}; }

private:
    char text_[512];
    char* end_;
};

void text(std::string_view line);
void text(ImVec4 colour, std::string_view line);
void wrappedText(std::string_view paragraph);
void wrappedText(ImVec4 colour, std::string_view paragraph);
// Ends at the right edge of the current table cell or of the region.
void rightText(std::string_view line);

// "1.5 MiB"
ShortText bytesText(uint64_t bytes);

// "1024 × 1024 × 6"
ShortText extentText(const Extent& extent);

// A foldable part of the side panel.
bool section(const char* title, bool openAtFirst);
// A quiet title with a line, inside a section.
// `reserved` units on the right stay free.
void subtitle(std::string_view title, float reserved = 0);

// Starts a row: the label on the left, the next control fills the rest but for `reserved` units on its right.
void row(std::string_view label, float reserved = 0);
// A tooltip of one paragraph for the item before.
void tooltip(std::string_view paragraph);
bool pointedAt();
// How far something is, and a button to cancel it, which stays the last item: true when it is pressed.
bool progressWithCancel(const Progress& progress);
// Between Begin and EndTooltip: a width that long help is wrapped at.
void beginHelp();
void endHelp();

// ImGui's popup and combo, which Escape closes too, unless a value is being typed in it.
bool beginPopup(const char* id);
bool beginCombo(const char* id, const char* shown, ImGuiComboFlags flags = 0);

// A button that shows whether what it toggles is on.
bool toggleButton(const char* label, bool on);

// An OpenGL texture as ImGui names it.
inline ImTextureID textureId(unsigned name) { return (ImTextureID)(intptr_t)name; }

// Text field over a std::string of at most `Capacity` bytes.
template <size_t Capacity> struct TextField {
    char bytes[Capacity] = {};
    std::string_view view() const { return bytes; }
    void set(std::string_view value) {
        const size_t size = value.copy(bytes, Capacity - 1);
        bytes[size] = 0;
    }
    bool edit(const char* id, const char* hint, ImGuiInputTextFlags flags = 0) {
        return ImGui::InputTextWithHint(id, hint, bytes, Capacity, flags);
    }
};

} // namespace penumbra
