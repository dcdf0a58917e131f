// SPDX-License-Identifier: MIT
#include "ui/thumbnails.h"

#include "ui/buffer_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace penumbra {

using glm::ivec2;

namespace {

constexpr int cellsAcross = 8;
constexpr double refreshInterval = 0.5;  // [s]
constexpr double secondsPerFrame = 2e-3; // spent on small pictures, until one is over

constexpr float widthInEms = 4.4f, heightInEms = 2.9f;

} // namespace

ivec2 Thumbnails::cornerOf(size_t cell) const {
    return ivec2(static_cast<int>(cell) % cellsAcross, static_cast<int>(cell) / cellsAcross) * cellSize_;
}

void Thumbnails::gather(const Flow& flow) {
    const auto& images = flow.images();
    entries_.clear();
    for (size_t i = 0; i < images.size(); ++i) {
        // The rounds of a repeat share one label: the last stands for all.
        const bool again = std::any_of(images.begin() + static_cast<ptrdiff_t>(i) + 1, images.end(),
                                       [&](const Flow::ImageNode& later) { return later.label == images[i].label; });
        if (again) continue;
        const Stage stage = flow.passes()[static_cast<size_t>(images[i].pass)].stage;
        entries_.push_back({stage, images[i].label, flow.image(static_cast<int>(i))});
        for (const auto& [label, image] : flow.aliases())
            if (image == static_cast<int>(i)) entries_.push_back({stage, label, flow.image(image)});
    }
}

const std::string* Thumbnails::draw(const Renderer& renderer, Inspector& inspector, uint64_t frame,
                                    std::string_view chosen, float pixelsPerUnit) {
    const Flow& flow = renderer.flow();
    gather(flow);
    const float em = ImGui::GetFontSize();
    const ivec2 cellSize(std::lround(widthInEms * em * pixelsPerUnit), std::lround(heightInEms * em * pixelsPerUnit));
    const int lines = (static_cast<int>(entries_.size()) + cellsAcross - 1) / cellsAcross;
    if (!atlas_.name() || cellSize != cellSize_ || atlas_.extent().height < lines * cellSize.y) {
        atlas_ = Texture("ui.thumbnails", Format::RGBA8,
                         {.width = cellsAcross * cellSize.x, .height = std::max(lines, 2) * cellSize.y});
        cellSize_ = cellSize;
        cells_.clear();
    }
    cells_.resize(entries_.size());

    const std::string* picked = nullptr;
    std::optional<Stage> stage;
    const auto start = std::chrono::steady_clock::now();
    for (size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        if (stage != entry.stage) subtitle(stageName(entry.stage));
        stage = entry.stage;
        Cell& cell = cells_[i];
        ImGui::PushID(entry.label);
        if (row(flow, entry, flow.label(entry.label) == chosen, i, pixelsPerUnit)) picked = &flow.label(entry.label);
        const bool stale = cell.label != entry.label || (cell.frame != frame && ImGui::GetTime() >= cell.next);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        if (stale && ImGui::IsItemVisible() && spent.count() < secondsPerFrame)
            paint(renderer, inspector, frame, entry, cell, cornerOf(i));
        ImGui::PopID();
    }
    return picked;
}

bool Thumbnails::row(const Flow& flow, const Entry& entry, bool chosen, size_t index, float pixelsPerUnit) {
    const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemInnerSpacing.x,
                line = ImGui::GetTextLineHeight();
    const float width = ImGui::GetContentRegionAvail().x;
    const bool narrow = width < 2 * widthInEms * em; // the name below instead of beside
    const ImVec2 at = ImGui::GetCursorScreenPos(), size{widthInEms * em, heightInEms * em};
    const bool pressed = ImGui::Selectable("##image", chosen, 0, {0, size.y + (narrow ? line : 0)});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 from(std::round(at.x * pixelsPerUnit) / pixelsPerUnit,
                      std::round(at.y * pixelsPerUnit) / pixelsPerUnit);
    const ImVec2 to(from.x + static_cast<float>(cellSize_.x) / pixelsPerUnit,
                    from.y + static_cast<float>(cellSize_.y) / pixelsPerUnit);
    list.AddRectFilled(from, to, IM_COL32(0, 0, 0, 255));
    if (cells_[index].label == entry.label) {
        const glm::vec2 all(atlas_.extent().width, atlas_.extent().height);
        const glm::vec2 low = glm::vec2(cornerOf(index)) / all, high = glm::vec2(cornerOf(index) + cellSize_) / all;
        list.AddImage(textureId(atlas_.name()), from, to, {low.x, low.y}, {high.x, high.y});
    }
    if (chosen) list.AddRect(from, to, ImGui::GetColorU32(colour::accent), 0, 0, 0.12f * em);

    // "a/owner.image": the image's own name over that of whom it belongs to.
    const std::string_view label = flow.label(entry.label);
    const size_t dot = label.rfind('.');
    const std::string_view name = dot == std::string::npos ? label : label.substr(dot + 1);
    const std::string_view owner = dot == std::string::npos ? std::string_view() : label.substr(0, dot);
    const ImVec4 clip(at.x, at.y, at.x + width, to.y + line);
    const auto write = [&](ImVec2 place, ImVec4 ink, std::string_view words) {
        if (words.empty()) return;
        list.AddText(ImGui::GetFont(), em, place, ImGui::GetColorU32(ink), words.data(), words.data() + words.size(), 0,
                     &clip);
    };
    const ImVec2 beside(to.x + gap, at.y + (size.y - (owner.empty() ? 1 : 2) * line) / 2);
    write(narrow ? ImVec2(at.x, to.y) : beside, chosen ? colour::accent : colour::text, name);
    if (!narrow) write({beside.x, beside.y + line}, colour::muted, owner);

    const ImageSpec& spec = flow.spec(entry.image);
    tooltip(ShortText("{}\n{}  {}  {}{}{}", label, extentText(spec.extent).view(), info(spec.format).name,
                      bytesText(spec.bytes()).view(), cells_[index].trouble.empty() ? "" : "\n", cells_[index].trouble)
                .view());
    return pressed;
}

void Thumbnails::paint(const Renderer& renderer, Inspector& inspector, uint64_t frame, const Entry& entry, Cell& cell,
                       ivec2 corner) {
    const ImageSpec& spec = renderer.flow().spec(entry.image);
    const Source source{renderer.runner().texture(renderer.flow(), entry.image), spec.channels};
    cell.frame = frame;
    cell.next = ImGui::GetTime() + refreshInterval;
    try {
        Look look = firstLook(spec);
        if (!hasStatedRange(spec, look.channel))
            look.range = nonEmpty(inspector.range(source, look.channel).value_or(ValueRange()));
        // All of it, in the middle.
        const glm::dvec2 texels(source.size()), pixels(cellSize_);
        const double texelsPerPixel = std::max(texels.x / pixels.x, texels.y / pixels.y);
        const glm::dvec2 first = (texels - pixels * texelsPerPixel) / 2.0;
        inspector.paint(source, look, {first.x, first.y, texelsPerPixel}, atlas_, corner, cellSize_);
        cell.label = entry.label;
        cell.trouble.clear();
    } catch (const std::exception& error) { // a shader that does not compile
        cell.trouble = error.what();
    }
}

} // namespace penumbra
