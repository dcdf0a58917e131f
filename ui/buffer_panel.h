// SPDX-License-Identifier: MIT
// Every image of the frame, and one of them in detail: channels, range, zoom, the value under the pointer.
#pragma once

#include "ui/image_mapping.h"
#include "ui/widgets.h"

#include <optional>

namespace penumbra {

class BufferPanel {
public:
    // Draws into the current ImGui window. `frame` counts the frames rendered: the picked image is read back again, a
    // few times a second at most, when it changed. `pixelsPerUnit` is the framebuffer's scale.
    void draw(const Renderer& renderer, uint64_t frame, float pixelsPerUnit);

private:
    enum class RangeMode { Automatic, Stated, Typed };

    void list(const Flow& flow);
    void pick(const Flow& flow, Image image);
    void readBack(const Renderer& renderer, Image image, uint64_t frame);
    void controls(const Flow& flow, const ImageSpec& spec);
    void view(const ImageSpec& spec, float pixelsPerUnit);
    void navigate(ImVec2 corner, ImVec2 size);
    void drawPixels(ImVec2 corner, ImVec2 size, float pixelsPerUnit);
    void probe(const ImageSpec& spec, ImVec2 corner);
    void updateRange(const ImageSpec& spec);
    double unitsPerTexel(ImVec2 size) const;

    std::string picked_; // label
    int channel_ = 0;    // −1: red, green and blue together
    int layer_ = 0, level_ = 0;
    RangeMode mode_ = RangeMode::Automatic;
    ValueRange range_, typed_;

    Renderer::Pixels pixels_;
    BadTexels bad_;
    std::string trouble_; // why nothing could be read
    std::optional<uint64_t> frameRead_;
    double nextRead_ = 0; // ImGui's time [s]
    std::vector<float> scratch_;

    std::optional<double> zoom_;       // window units per texel; none: all of it fits
    double centreX_ = 0, centreY_ = 0; // texel in the middle, from the upper left

    // What the view's texture was made from.
    struct Drawn {
        uint64_t frame = 0;
        ImageWindow window;
        ShownChannels channels{};
        ValueRange range;
        int width = 0, height = 0;
        bool operator==(const Drawn&) const = default;
    };
    Drawn drawn_;
    Texture texture_;
    std::vector<uint8_t> rgba_;
};

} // namespace penumbra
