// SPDX-License-Identifier: MIT
// The list of all images of the frame by stage, each with a small picture of itself.
#pragma once

#include "renderer/inspect/inspector.h"
#include "renderer/renderer.h"
#include "ui/widgets.h"

#include <string>
#include <vector>

namespace penumbra {

class Thumbnails {
public:
    // Draws into the current ImGui window; returns the label that was picked. Small pictures are painted anew when
    // there is another frame, at most twice a second each and only those that are visible.
    const std::string* draw(const Renderer& renderer, Inspector& inspector, uint64_t frame, std::string_view chosen,
                            float pixelsPerUnit);
    void release() {
        atlas_ = {};
        cells_.clear();
    }

private:
    struct Entry {
        Stage stage;
        int label; // also another name of an image that several instances share
        Image image;
    };
    struct Cell {
        int label = -1; // whose picture it holds
        uint64_t frame = 0;
        double next = 0; // when it may be painted again, ImGui's time [s]
        std::string trouble;
    };
    void gather(const Flow& flow);
    glm::ivec2 cornerOf(size_t cell) const; // in the atlas
    bool row(const Flow& flow, const Entry& entry, bool chosen, size_t cell, float pixelsPerUnit);
    void paint(const Renderer& renderer, Inspector& inspector, uint64_t frame, const Entry& entry, Cell& cell,
               glm::ivec2 corner);

    std::vector<Entry> entries_;
    std::vector<Cell> cells_;
    Texture atlas_;
    glm::ivec2 cellSize_{0}; // pixels
};

} // namespace penumbra
