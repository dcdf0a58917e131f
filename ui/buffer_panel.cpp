// SPDX-License-Identifier: MIT
#include "ui/buffer_panel.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// In font heights:
constexpr float listWidth = 12.5f, narrowListWidth = 5.6f, controlsWidth = 17, narrowPanel = 46;

constexpr double measuringShare = 0.1; // of the time: measuring stalls the renderer

} // namespace

std::optional<BufferShot> BufferPanel::draw(Renderer& renderer, uint64_t frame, float pixelsPerUnit) {
    if (!inspector_) inspector_.emplace(renderer.programs());
    const float em = ImGui::GetFontSize(), available = ImGui::GetContentRegionAvail().x;
    const float gap = ImGui::GetStyle().ItemSpacing.x, scrollbar = ImGui::GetStyle().ScrollbarSize;
    const float list = (available < narrowPanel * em ? narrowListWidth : listWidth) * em + scrollbar;
    const float controls = std::min(controlsWidth * em + scrollbar, 0.4f * available);

    ImGui::BeginChild("images", {list, 0}, false);
    const std::string* picked = thumbnails_.draw(renderer, *inspector_, frame, views_[chosen_].label(), pixelsPerUnit);
    ImGui::EndChild();
    pick(renderer, picked);
    for (size_t i = 0; i < mostViews; ++i) {
        present_[i] = i < count_ && views_[i].update(renderer, *inspector_, frame, measuringShare / count_);
        if (!present_[i]) views_[i].hide();
    }

    ImGui::SameLine();
    ImGui::BeginChild("views", {std::max(ImGui::GetContentRegionAvail().x - controls - gap, 1.0f), 0}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    toolbar();
    drawViews(ImGui::GetContentRegionAvail(), pixelsPerUnit);
    ImGui::EndChild();

    ImGui::SameLine();
    ImGui::BeginChild("controls", {0, 0}, false, ImGuiWindowFlags_AlwaysVerticalScrollbar);
    std::optional<BufferShot> shot;
    if (present_[chosen_]) shot = views_[chosen_].drawControls(*inspector_, sight(chosen_));
    ImGui::EndChild();
    return shot;
}

void BufferPanel::close() {
    if (!inspector_) return;
    inspector_.reset();
    thumbnails_.release();
    for (BufferView& view : views_) view.release();
}

void BufferPanel::pick(const Renderer& renderer, const std::string* label) {
    const Flow& flow = renderer.flow();
    if (label && *label != views_[chosen_].label()) views_[chosen_].pick(flow, *label);
    // What is not there any more, as after a change of technique, gives way, unless it is kept.
    for (size_t i = 0; i < count_; ++i)
        if (!views_[i].frozen() && !flow.find(views_[i].label())) views_[i].pick(flow, another(renderer));
}

// ψ, or else the nearest image before it that no view shows.
std::string_view BufferPanel::another(const Renderer& renderer) const {
    const Flow& flow = renderer.flow();
    for (int i = renderer.shadow().index(); i >= 0; --i) {
        const std::string& label = flow.label(flow.image(i));
        const bool shown = std::any_of(views_.begin(), views_.begin() + static_cast<ptrdiff_t>(count_),
                                       [&](const BufferView& view) { return view.label() == label; });
        if (!shown) return label;
    }
    return flow.label(renderer.shadow());
}

void BufferPanel::toolbar() {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    for (const size_t count : {1, 2, 4}) {
        ImGui::PushID(static_cast<int>(count));
        if (toggleButton(ShortText("{}", count).begin(), count_ == count)) {
            count_ = count;
            chosen_ = std::min(chosen_, count_ - 1);
        }
        tooltip(count == 1 ? "One view"
                           : "Several views side by side; a click chooses the one that the list and the "
                             "controls are for");
        ImGui::PopID();
        ImGui::SameLine(0, gap);
    }
    ImGui::SameLine();
    if (toggleButton("Fit", sight(chosen_).magnification == 1)) sight(chosen_) = {};
    tooltip("The whole image");
    ImGui::SameLine(0, gap);
    const double oneToOne = views_[chosen_].magnificationOfOneToOne();
    if (toggleButton("1:1", std::abs(sight(chosen_).magnification - oneToOne) < 1e-9))
        sight(chosen_).magnification = oneToOne;
    tooltip(
        "One texel is one pixel of the screen. The wheel zooms, dragging moves; a click pins a texel, a right click "
        "lets it go.");
    if (count_ > 1) {
        ImGui::SameLine();
        if (toggleButton("Linked", linked_)) {
            if (linked_)
                own_.fill(shared_);
            else
                shared_ = own_[chosen_];
            linked_ = !linked_;
        }
        tooltip("All views look at the same place; pointer and pins go to all of them");
    }
}

void BufferPanel::drawViews(ImVec2 size, float pixelsPerUnit) {
    const float em = ImGui::GetFontSize(), gap = 0.5f * em;
    const size_t columns = count_ == 4 || (count_ == 2 && size.x > 1.2f * size.y) ? 2 : 1, rows = count_ / columns;
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 cell{(size.x - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns),
                      (size.y - gap * static_cast<float>(rows - 1)) / static_cast<float>(rows)};
    std::optional<glm::dvec2> pointer;
    size_t pointedView = 0;
    for (size_t i = 0; i < count_; ++i) {
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetCursorScreenPos({origin.x + static_cast<float>(i % columns) * (cell.x + gap),
                                   origin.y + static_cast<float>(i / columns) * (cell.y + gap)});
        const bool pointedElsewhere = linked_ && pointedView_ != i;
        const BufferView::Events events =
            views_[i].draw(*inspector_, cell, pixelsPerUnit, sight(i), pointedElsewhere ? pointer_ : std::nullopt,
                           i == chosen_ && count_ > 1);
        ImGui::PopID();
        if (events.touched) chosen_ = i;
        if (events.pointedAt) {
            pointer = events.pointedAt;
            pointedView = i;
        }
        for (size_t k = 0; k < count_; ++k) {
            if ((k != i && !linked_) || !present_[k]) continue;
            if (events.pinned) views_[k].pin(*events.pinned);
            if (events.unpinned) views_[k].unpin();
        }
    }
    pointer_ = pointer;
    pointedView_ = pointedView;
}

} // namespace penumbra
