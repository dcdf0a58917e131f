// SPDX-License-Identifier: MIT
#include "ui/histogram.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {

namespace {

constexpr int rampTexels = 512;
constexpr ImU32 channelInks[] = {IM_COL32(235, 90, 80, 150), IM_COL32(90, 200, 100, 150), IM_COL32(90, 140, 245, 150)};
constexpr ImU32 singleInk = IM_COL32(176, 180, 190, 255);

void drawBars(const Statistics& statistics, ImVec2 from, ImVec2 to) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    uint32_t highest = 1;
    for (int c = 0; c < statistics.channels; ++c)
        for (const uint32_t count : statistics.bins(c)) highest = std::max(highest, count);
    const float step = (to.x - from.x) / histogramBins, whole = std::log1p(static_cast<float>(highest));
    for (int c = 0; c < statistics.channels; ++c) {
        const auto bins = statistics.bins(c);
        const ImU32 ink = statistics.channels == 1 ? singleInk : channelInks[c];
        for (int i = 0; i < histogramBins; ++i) {
            const uint32_t count = bins[static_cast<size_t>(i)];
            if (count == 0) continue;
            const float height = std::log1p(static_cast<float>(count)) / whole * (to.y - from.y);
            const float x = from.x + static_cast<float>(i) * step;
            list.AddRectFilled({x, to.y - height}, {x + std::max(step, 1.0f), to.y}, ink);
        }
    }
}

} // namespace

void Histogram::paintBar(Inspector& inspector, ValueRange domain, const Look& look, std::span<const Channel> channels) {
    const bool sameRamp = ramp_.name() && rampDomain_ == domain;
    if (sameRamp && barLook_ == look && barChannels_ == channels.data()) return;
    if (!ramp_.name()) {
        ramp_ = Texture("ui.ramp", Format::R32F, {.width = rampTexels, .height = 1});
        bar_ = Texture("ui.colour-bar", Format::RGBA8, {.width = rampTexels, .height = 1});
    }
    if (!sameRamp) {
        std::array<float, rampTexels> values;
        for (int i = 0; i < rampTexels; ++i) {
            const double t = (i + 0.5) / rampTexels;
            values[static_cast<size_t>(i)] = static_cast<float>(domain.min * (1 - t) + domain.max * t);
        }
        glTextureSubImage2D(ramp_.name(), 0, 0, 0, rampTexels, 1, GL_RED, GL_FLOAT, values.data());
    }
    const size_t shown = static_cast<size_t>(std::max(look.channel, 0));
    Look first = look;
    first.channel = 0;
    first.marks = 0;
    if (look.channel < 0) first.map = ColourMap::Grey;
    inspector.paint({ramp_, channels.subspan(std::min(shown, channels.size()))}, first, {}, bar_, {0, 0},
                    {rampTexels, 1});
    rampDomain_ = domain;
    barLook_ = look;
    barChannels_ = channels.data();
}

bool Histogram::draw(Inspector& inspector, const Statistics& statistics, const Look& look,
                     std::span<const Channel> channels, ValueRange& range) {
    const float em = ImGui::GetFontSize(), width = std::max(ImGui::GetContentRegionAvail().x, 4 * em);
    const float barHeight = 0.55f * em, handle = 0.45f * em;
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size{width, 4.4f * em};
    const ImVec2 from{corner.x + handle, corner.y},
        to{corner.x + width - handle, corner.y + size.y - barHeight - handle};
    const ValueRange domain = statistics.domain;
    const double domainWidth = double{domain.max} - domain.min;
    const auto place = [&](float value) {
        const double share = std::clamp((double{value} - domain.min) / domainWidth, 0.0, 1.0);
        return from.x + static_cast<float>(share) * (to.x - from.x);
    };

    ImGui::InvisibleButton("histogram", size);
    const float pointer = ImGui::GetIO().MousePos.x;
    if (ImGui::IsItemActivated()) {
        const float low = std::abs(pointer - place(range.min)), high = std::abs(pointer - place(range.max));
        const bool between = pointer > place(range.min) && pointer < place(range.max);
        grab_ = between && std::min(low, high) > 0.8f * em ? Grab::Both : low < high ? Grab::Low : Grab::High;
        if (low == high) grab_ = pointer < place(range.min) ? Grab::Low : Grab::High;
    }
    if (!ImGui::IsItemActive()) grab_ = Grab::None;
    bool changed = false;
    if (const float moved = ImGui::GetIO().MouseDelta.x; grab_ != Grab::None && moved != 0) {
        const double least = domainWidth / 4096; // between the ends
        const auto at = [&](float x) {
            return domain.min + std::clamp((x - from.x) / (to.x - from.x), 0.0f, 1.0f) * domainWidth;
        };
        ValueRange edited = range;
        if (grab_ == Grab::Low) edited.min = static_cast<float>(std::min(at(pointer), range.max - least));
        if (grab_ == Grab::High) edited.max = static_cast<float>(std::max(at(pointer), range.min + least));
        if (grab_ == Grab::Both) {
            const double wanted = moved / (to.x - from.x) * domainWidth;
            const double step = std::clamp(wanted, std::min(double{domain.min} - range.min, 0.0),
                                           std::max(double{domain.max} - range.max, 0.0));
            edited = {static_cast<float>(range.min + step), static_cast<float>(range.max + step)};
        }
        changed = edited != range && edited.min < edited.max;
        if (changed) range = edited;
    }
    if (grab_ != Grab::None || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);

    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float low = place(range.min), high = place(range.max), below = to.y + barHeight;
    const ImU32 veil = IM_COL32(20, 20, 22, 150), ink = ImGui::GetColorU32(colour::accent);
    list.AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_FrameBg));
    for (const float x : {low, high}) list.AddLine({x, from.y}, {x, below}, ink, 0.15f * em);
    drawBars(statistics, from, to);  // over the lines: the ends are often where the peaks are
    const float beside = 0.15f * em; // what lies at an end belongs to the range
    if (low - beside > from.x) list.AddRectFilled(from, {low - beside, to.y}, veil);
    if (high + beside < to.x) list.AddRectFilled({high + beside, from.y}, to, veil);
    paintBar(inspector, domain, look, channels);
    list.AddImage(textureId(bar_.name()), {from.x, to.y}, {to.x, below});
    for (const float x : {low, high})
        list.AddTriangleFilled({x, below - 0.2f * em}, {x + handle, below + handle}, {x - handle, below + handle}, ink);
    tooltip("How many texels have which value; heights are logarithms of the counts. Drag the ends, or what is "
            "between them, to set the range that the colours cover.");
    return changed;
}

} // namespace penumbra
