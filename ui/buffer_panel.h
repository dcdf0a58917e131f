// SPDX-License-Identifier: MIT
// Every image of the frame, and some of them in detail side by side.
#pragma once

#include "ui/buffer_view.h"
#include "ui/thumbnails.h"

#include <array>

namespace penumbra {

class BufferPanel {
public:
    // Draws into the current ImGui window. `frame` counts the frames rendered; `pixelsPerUnit` is the framebuffer's
    // scale. A picture comes back when one is to be saved.
    std::optional<BufferShot> draw(Renderer& renderer, uint64_t frame, float pixelsPerUnit);
    // While nobody looks: gives back what can be had again. Costs nothing when called again.
    void close();

private:
    static constexpr size_t mostViews = 4;

    void toolbar();
    void pick(const Renderer& renderer, const std::string* label);
    std::string_view another(const Renderer& renderer) const;
    void drawViews(ImVec2 size, float pixelsPerUnit);
    Sight& sight(size_t view) { return linked_ ? shared_ : own_[view]; }

    std::optional<Inspector> inspector_; // while open
    Thumbnails thumbnails_;
    std::array<BufferView, mostViews> views_;
    std::array<bool, mostViews> present_{};
    size_t count_ = 1, chosen_ = 0;
    bool linked_ = true;
    Sight shared_;
    std::array<Sight, mostViews> own_;
    std::optional<glm::dvec2> pointer_; // in image coordinates, where a view was pointed at in the last frame
    size_t pointedView_ = 0;
};

} // namespace penumbra
