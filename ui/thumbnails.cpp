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
            paint(renderer, inspector, frame, entry, cell,
                  ivec2(static_cast<int>(i) % cellsAcross, static_cast<int>(i) / cellsAcross) * cellSize_);
        ImGui::PopID();
    }
    return picked;
}

bool Thumbnails::row(const Flow& flow, const Entry& entry, bool chosen, size_t index, float pixelsPerUnit) {
    const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const ImVec2 at = ImGui::GetCursorScreenPos(), size{widthInEms * em, heightInEms * em};
    const float width = ImGui::GetContentRegionAvail().x;
    const bool pressed = ImGui::Selectable("##image", chosen, 0, {0, size.y});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(0, 0, 0, 255));
    if (cells_[index].label == entry.label) {
        const ivec2 corner =
            ivec2(static_cast<int>(index) % cellsAcross, static_cast<int>(index) / cellsAcross) * cellSize_;
        const float w = static_cast<float>(atlas_.extent().width), h = static_cast<float>(atlas_.extent().height);
        const ImVec2 first(static_cast<float>(corner.x) / w, static_cast<float>(corner.y) / h);
        const ImVec2 last(static_cast<float>(corner.x + cellSize_.x) / w,
                          static_cast<float>(corner.y + cellSize_.y) / h);
        const ImVec2 from(std::round(at.x * pixelsPerUnit) / pixelsPerUnit,
                          std::round(at.y * pixelsPerUnit) / pixelsPerUnit);
        list.AddImage(textureId(atlas_.name()), from,
                      {from.x + static_cast<float>(cellSize_.x) / pixelsPerUnit,
                       from.y + static_cast<float>(cellSize_.y) / pixelsPerUnit},
                      first, last);
    }
    if (chosen) list.AddRect(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(colour::accent), 0, 0, 0.12f * em);

    // "a/pcss.shadow-map": the image's own name over that of whom it belongs to.
    const std::string& label = flow.label(entry.label);
    const size_t dot = label.rfind('.');
    const std::string_view whole = label, name = dot == std::string::npos ? whole : whole.substr(dot + 1);
    const std::string_view owner = dot == std::string::npos ? std::string_view() : whole.substr(0, dot);
    const ImageSpec& spec = flow.spec(entry.image);
    const float left = at.x + size.x + gap, line = ImGui::GetTextLineHeight();
    const ImVec4 clip(left, at.y, at.x + width, at.y + size.y);
    const auto write = [&](float y, ImVec4 ink, std::string_view words) {
        list.AddText(ImGui::GetFont(), em, {left, y}, ImGui::GetColorU32(ink), words.data(),
                     words.data() + words.size(), 0, &clip);
    };
    const float top = at.y + (size.y - 2 * line) / 2;
    write(top, chosen ? colour::accent : colour::text, name);
    write(top + line, colour::muted, owner.empty() ? info(spec.format).name : owner);
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
