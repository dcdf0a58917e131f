// SPDX-License-Identifier: MIT
#include "ui/plot.h"

#include <cmath>

namespace penumbra {

ShortText tickText(double value) {
    return value != 0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e5) ? ShortText("{:.0e}", value)
                                                                            : ShortText("{:g}", value);
}

ImU32 faded(ImVec4 colour, float opacity) {
    colour.w = opacity;
    return ImGui::GetColorU32(colour);
}

float widthOf(std::string_view line) { return ImGui::CalcTextSize(line.data(), line.data() + line.size()).x; }

ImVec4 lineColour(size_t i) {
    static const ImVec4 colours[] = {colour::accent,           {0.45f, 0.70f, 0.95f, 1}, {0.55f, 0.82f, 0.50f, 1},
                                     {0.85f, 0.55f, 0.85f, 1}, {0.95f, 0.85f, 0.40f, 1}, {0.40f, 0.82f, 0.80f, 1},
                                     {0.92f, 0.48f, 0.45f, 1}, {0.60f, 0.58f, 0.95f, 1}, {0.75f, 0.65f, 0.50f, 1},
                                     {0.95f, 0.62f, 0.75f, 1}};
    return colours[i % std::size(colours)];
}

ImVec2 Plot::low() const {
    const float em = ImGui::GetFontSize();
    return {corner.x + 4.4f * em, corner.y + size.y - 2.9f * em};
}

ImVec2 Plot::high() const {
    const float em = ImGui::GetFontSize();
    return {corner.x + size.x - em, corner.y + 1.9f * em};
}

bool Plot::drawable() const {
    const float em = ImGui::GetFontSize();
    return high().x - low().x >= 4 * em && low().y - high().y >= 3 * em;
}

ImVec2 Plot::at(double x, double y) const {
    const ImVec2 from = low(), to = high();
    return {std::lerp(from.x, to.x, static_cast<float>(across.position(x))),
            std::lerp(from.y, to.y, static_cast<float>(up.position(y)))};
}

void Plot::drawPaper() const {
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                                              ImGui::GetColorU32(ImGuiCol_FrameBg), 0.25f * ImGui::GetFontSize());
}

void Plot::drawAxes() const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 from = low(), to = high();
    const float em = ImGui::GetFontSize(), gap = 0.35f * em;
    const ImU32 grid = faded(colour::text, 0.09f), ink = ImGui::GetColorU32(colour::muted);
    for (const double tick : ticksOf(across, static_cast<int>((to.x - from.x) / (4 * em)))) {
        const float x = std::round(at(tick, 0).x);
        list.AddLine({x, to.y}, {x, from.y}, grid);
        const ShortText label = tickText(tick);
        list.AddText({x - widthOf(label.view()) / 2, from.y + gap}, ink, label.begin(), label.end());
    }
    for (const double tick : ticksOf(up, static_cast<int>((from.y - to.y) / (2 * em)))) {
        const float y = std::round(at(0, tick).y);
        list.AddLine({from.x, y}, {to.x, y}, grid);
        const ShortText label = tickText(tick);
        list.AddText({from.x - widthOf(label.view()) - gap, y - ImGui::GetTextLineHeight() / 2}, ink, label.begin(),
                     label.end());
    }
    list.AddLine({from.x, to.y}, from, ink);
    list.AddLine(from, {to.x, from.y}, ink);
    const ImU32 bright = ImGui::GetColorU32(colour::text);
    list.AddText({corner.x + 0.6f * em, corner.y + 0.3f * em}, bright, upTitle.data(), upTitle.data() + upTitle.size());
    list.AddText({to.x - widthOf(acrossTitle), corner.y + size.y - 1.35f * em}, bright, acrossTitle.data(),
                 acrossTitle.data() + acrossTitle.size());
}

} // namespace penumbra
