// SPDX-License-Identifier: MIT
#include "ui/ruler.h"

#include "renderer/measure/edge_profile.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float samplesPerPixel = 2;
constexpr float mostSamples = 4096;
constexpr float plotHeight = 8, lowPlotHeight = 4.5f; // font heights

ImVec2 vec(glm::vec2 v) { return {v.x, v.y}; }

std::pair<glm::vec2, glm::vec2> onScreen(const RulerLine& line, const ScreenView& screen) {
    return {screen.corner + line.from * screen.size, screen.corner + line.to * screen.size};
}

int lines(const Yardstick& yardstick) {
    const Snapshot* shot = yardstick.snapshot();
    return 1 + (shot && !shot->shadow[1].empty()) + (yardstick.truth() != nullptr);
}

ShortText widthText(const Snapshot& shot, glm::vec2 from, glm::vec2 to, std::span<const float> profile) {
    const std::optional<EdgeWidth> edge = edgeWidth(profile);
    if (!edge) return ShortText("does not pass 10 % and 90 %");
    const auto place = [&](double sample) {
        return glm::mix(from, to, static_cast<float>(sample / static_cast<double>(profile.size() - 1)));
    };
    const glm::vec2 low = place(edge->at10), high = place(edge->at90);
    const float pixels = glm::distance(low, high);
    const auto lowWorld = surfaceWorld(shot.view, shot.depth, low),
               highWorld = surfaceWorld(shot.view, shot.depth, high);
    if (!lowWorld || !highWorld || !onOneSurface(shot.view, shot.depth, low, high))
        return ShortText("{:.1f} px   on two surfaces", pixels);
    return ShortText("{:.1f} px   {:.3g} m", pixels, glm::distance(*lowWorld, *highWorld));
}

} // namespace

RulerGrip gripAt(const RulerLine& line, const ScreenView& screen, glm::vec2 pointer, float reach) {
    const auto [from, to] = onScreen(line, screen);
    if (glm::distance(pointer, from) <= reach) return RulerGrip::From;
    if (glm::distance(pointer, to) <= reach) return RulerGrip::To;
    const glm::vec2 along = to - from;
    const float t = glm::clamp(glm::dot(pointer - from, along) / std::max(glm::dot(along, along), 1e-6f), 0.0f, 1.0f);
    return glm::distance(pointer, from + t * along) <= 0.6f * reach ? RulerGrip::Both : RulerGrip::None;
}

void dragRuler(RulerLine& line, RulerGrip grip, const ScreenView& screen, glm::vec2 delta) {
    glm::vec2 share = delta / screen.size;
    if (grip == RulerGrip::Both) // without bending it
        share = glm::clamp(share, -glm::min(line.from, line.to), 1.0f - glm::max(line.from, line.to));
    if (grip == RulerGrip::From || grip == RulerGrip::Both)
        line.from = glm::clamp(line.from + share, glm::vec2(0), glm::vec2(1));
    if (grip == RulerGrip::To || grip == RulerGrip::Both)
        line.to = glm::clamp(line.to + share, glm::vec2(0), glm::vec2(1));
}

void drawRuler(const RulerLine& line, const ScreenView& screen, RulerGrip lit) {
    const auto [from, to] = onScreen(line, screen);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize(), width = 0.13f * em;
    const ImU32 ink = ImGui::GetColorU32(colour::accent), bright = IM_COL32(255, 255, 255, 255),
                dark = IM_COL32(0, 0, 0, 150);
    list.AddLine(vec(from), vec(to), dark, 2.4f * width);
    list.AddLine(vec(from), vec(to), lit == RulerGrip::Both ? bright : ink, width);
    for (const auto& [end, grip] : {std::pair(from, RulerGrip::From), std::pair(to, RulerGrip::To)}) {
        list.AddCircle(vec(end), 0.42f * em, dark, 0, 2.4f * width);
        list.AddCircle(vec(end), 0.42f * em, lit == grip ? bright : ink, 0, 1.2f * width);
    }
}

float RulerPlot::height(const Yardstick& yardstick, bool low) {
    const float line = ImGui::GetTextLineHeightWithSpacing();
    return (low ? lowPlotHeight : plotHeight) * ImGui::GetFontSize() +
           (1 + static_cast<float>(lines(yardstick))) * line;
}

void RulerPlot::draw(const RulerLine& line, const Yardstick& yardstick, bool low) {
    const Snapshot* shot = yardstick.snapshot();
    const Truth* truth = yardstick.truth();
    const float em = ImGui::GetFontSize();
    text(colour::muted, "Penumbra, from ψ = 0.1 to 0.9");
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, (low ? lowPlotHeight : plotHeight) * em};
    ImGui::Dummy(size);
    tooltip(
        "ψ along the ruler, from its left end to its right one: 1 where the whole light is hidden. The width is the "
        "distance between the places where ψ is 0.1 and 0.9");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float axis = 2.4f * em; // left of the plot
    const ImVec2 start{corner.x + axis, corner.y + size.y - 0.5f * em}, high{corner.x + size.x, corner.y + 0.5f * em};
    const auto y = [&](float value) { return start.y + (high.y - start.y) * value; };
    const ImU32 faint = ImGui::GetColorU32(ImGuiCol_Separator), muted = ImGui::GetColorU32(colour::muted);
    for (const float level : {0.0f, 0.1f, 0.9f, 1.0f})
        list.AddLine({start.x, y(level)}, {high.x, y(level)}, faint, level == 0 || level == 1 ? 1.0f : 0.08f * em);
    for (const float level : {0.1f, 0.9f}) {
        const ShortText mark("{:.1f}", level);
        list.AddText({corner.x, y(level) - em / 2}, muted, mark.begin(), mark.end());
    }
    if (!shot) return text(colour::muted, "ψ is being read…");

    glm::vec2 from = line.from * glm::vec2(shot->view.size), to = line.to * glm::vec2(shot->view.size);
    if (to.x < from.x) std::swap(from, to);
    const float length = std::min(samplesPerPixel * glm::distance(from, to), mostSamples - 1);
    const size_t count = static_cast<size_t>(length) + 2;
    const std::array<std::span<const float>, 3> images{
        shot->shadow[0], shot->shadow[1], truth ? std::span<const float>(truth->psi) : std::span<const float>()};
    const std::array<ImVec4, 3> inks{colour::accent, ImVec4(0.45f, 0.70f, 0.95f, 1), colour::text};
    const std::array<std::string_view, 3> titles{"A", "B", "truth"};
    for (size_t i = 3; i-- > 0;) { // the technique above the others
        profiles_[i].clear();
        if (images[i].empty()) continue;
        sampleLine(images[i], shot->view.size, from, to, count, profiles_[i]);
        const ImU32 ink = ImGui::GetColorU32(inks[i]);
        const auto point = [&](size_t k) {
            const float t = static_cast<float>(k) / static_cast<float>(count - 1);
            return ImVec2(start.x + (high.x - start.x) * t, y(std::clamp(profiles_[i][k], -0.05f, 1.05f)));
        };
        for (size_t k = 1; k < count; ++k) list.AddLine(point(k - 1), point(k), ink, 0.12f * em);
    }
    for (size_t i = 0; i < 3; ++i) {
        if (profiles_[i].empty()) continue;
        text(inks[i], titles[i]);
        ImGui::SameLine();
        rightText(widthText(*shot, from, to, profiles_[i]).view());
    }
}

} // namespace penumbra
