// SPDX-License-Identifier: MIT
#include "ui/theme.h"

#include <filesystem>
#include <system_error>

namespace penumbra {

namespace {

constexpr const char* fontFiles[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",   // Debian, Ubuntu
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", // Fedora
    "/usr/share/fonts/TTF/DejaVuSans.ttf",               // Arch
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/local/share/fonts/dejavu/DejaVuSans.ttf",
};

// Pairs of first and last code point: Latin, combining marks, Greek, subscript letters, punctuation, super- and
// subscripts, letter-like signs, arrows, operators, shapes.
constexpr ImWchar glyphRanges[] = {0x0020, 0x017F, 0x0300, 0x036F, 0x0370, 0x03FF, 0x1D62,
                                   0x1D6A, 0x2010, 0x205E, 0x2070, 0x209C, 0x2100, 0x214F,
                                   0x2190, 0x21FF, 0x2200, 0x22FF, 0x25A0, 0x25FF, 0};

ImVec4 grey(float value) { return {value * 0.96f, value * 0.98f, value * 1.08f, 1}; }

ImVec4 accent(float alpha) { return {colour::accent.x, colour::accent.y, colour::accent.z, alpha}; }

} // namespace

void applyTheme(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    style.WindowPadding = {12, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.CellPadding = {6, 3};
    style.IndentSpacing = 16;
    style.ScrollbarSize = 12;
    style.GrabMinSize = 10;
    style.WindowRounding = 0;
    style.ChildRounding = 4;
    style.FrameRounding = 4;
    style.PopupRounding = 6;
    style.ScrollbarRounding = 6;
    style.GrabRounding = 3;
    style.TabRounding = 4;
    style.WindowBorderSize = 0;
    style.ChildBorderSize = 0;
    style.PopupBorderSize = 1;
    style.WindowTitleAlign = {0, 0.5f};
    style.ScaleAllSizes(scale);

    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = colour::text;
    c[ImGuiCol_TextDisabled] = colour::muted;
    c[ImGuiCol_WindowBg] = grey(0.118f);
    c[ImGuiCol_ChildBg] = {0, 0, 0, 0};
    c[ImGuiCol_PopupBg] = grey(0.142f);
    c[ImGuiCol_Border] = grey(0.26f);
    c[ImGuiCol_FrameBg] = grey(0.185f);
    c[ImGuiCol_FrameBgHovered] = grey(0.225f);
    c[ImGuiCol_FrameBgActive] = grey(0.25f);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = grey(0.165f);
    c[ImGuiCol_MenuBarBg] = grey(0.142f);
    c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    c[ImGuiCol_ScrollbarGrab] = grey(0.26f);
    c[ImGuiCol_ScrollbarGrabHovered] = grey(0.33f);
    c[ImGuiCol_ScrollbarGrabActive] = grey(0.40f);
    c[ImGuiCol_CheckMark] = colour::accent;
    c[ImGuiCol_SliderGrab] = grey(0.46f);
    c[ImGuiCol_SliderGrabActive] = colour::accent;
    c[ImGuiCol_Button] = grey(0.215f);
    c[ImGuiCol_ButtonHovered] = grey(0.275f);
    c[ImGuiCol_ButtonActive] = grey(0.33f);
    c[ImGuiCol_Header] = grey(0.175f);
    c[ImGuiCol_HeaderHovered] = grey(0.225f);
    c[ImGuiCol_HeaderActive] = grey(0.26f);
    c[ImGuiCol_Separator] = grey(0.22f);
    c[ImGuiCol_SeparatorHovered] = accent(0.55f);
    c[ImGuiCol_SeparatorActive] = colour::accent;
    c[ImGuiCol_Tab] = c[ImGuiCol_TabUnfocused] = grey(0.15f);
    c[ImGuiCol_TabHovered] = grey(0.28f);
    c[ImGuiCol_TabActive] = c[ImGuiCol_TabUnfocusedActive] = grey(0.235f);
    c[ImGuiCol_TableHeaderBg] = grey(0.165f);
    c[ImGuiCol_TableBorderStrong] = c[ImGuiCol_TableBorderLight] = grey(0.2f);
    c[ImGuiCol_TableRowBgAlt] = {1, 1, 1, 0.02f};
    c[ImGuiCol_TextSelectedBg] = accent(0.30f);
    c[ImGuiCol_DragDropTarget] = c[ImGuiCol_NavHighlight] = colour::accent;
    c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.5f};
}

bool loadFont(float pixels) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 2;
    for (const char* file : fontFiles) {
        std::error_code ignored;
        if (std::filesystem::is_regular_file(file, ignored) &&
            fonts.AddFontFromFileTTF(file, pixels, &config, glyphRanges))
            return true;
    }
    config.SizePixels = pixels;
    fonts.AddFontDefault(&config);
    return false;
}

} // namespace penumbra
