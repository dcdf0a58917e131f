// SPDX-License-Identifier: MIT
// One image of the frame in detail: its texels as colours, the value under the pointer, a pinned texel over time.
#pragma once

#include "renderer/core/picture.h"
#include "renderer/renderer.h"
#include "ui/histogram.h"

#include <array>
#include <optional>

namespace penumbra {

// Where a view looks, in image coordinates from the upper left corner, both in [0, 1].
struct Sight {
    glm::dvec2 centre{0.5, 0.5};
    double magnification = 1; // 1: the whole image fits
    bool operator==(const Sight&) const = default;
};

// A picture that is to be saved.
struct BufferShot {
    std::string label;
    Picture picture; // as seen: R, G and B in [0, 1], sRGB encoded; raw: every channel under its name
    bool raw = false;
};

// What is shown of a picked image at first.
Look firstLook(const ImageSpec& spec);
bool hasStatedRange(const ImageSpec& spec, int channel);

// "0.734 m"
ShortText valueText(float value, std::string_view unit);
std::string_view channelName(const ImageSpec& spec, int channel);

class BufferView {
public:
    // By a label of the frame's, to look at it as its channels ask for.
    void pick(const Flow& flow, std::string_view label);
    const std::string& label() const { return label_; }
    bool picked() const { return !label_.empty(); }
    bool frozen() const { return frozen_.has_value(); }

    // Finds the image in the frame that was rendered last, and measures it again if it is another one: at most four
    // times a second, and at most for this share of the time. The same `frame`, the same images. False: it is not
    // there.
    bool update(const Renderer& renderer, Inspector& inspector, uint64_t frame, double share);
    // Nothing is known of the frame until the next update.
    void hide() { texture_ = nullptr; }

    struct Events {
        bool touched = false;                // pressed or scrolled
        std::optional<glm::dvec2> pinned;    // clicked there, in image coordinates
        bool unpinned = false;               // clicked with the right button
        std::optional<glm::dvec2> pointedAt; // the pointer is there
    };
    // Caption and image. `pointer`: where the pointer is, in this view or in a linked one, in image coordinates.
    Events draw(Inspector& inspector, ImVec2 size, float pixelsPerUnit, Sight& sight, std::optional<glm::dvec2> pointer,
                bool chosen);
    // Everything else about the image; a shot if one is to be saved.
    std::optional<BufferShot> drawControls(Inspector& inspector, Sight& sight);

    void pin(glm::dvec2 place);
    void unpin() { pin_.reset(); }
    // One texel is one pixel of the screen.
    double magnificationOfOneToOne() const { return fitScale_ > 0 ? 1 / fitScale_ : 1; }
    // Frees what can be painted again.
    void release();

private:
    enum class RangeMode { Automatic, Stated, Typed };
    static constexpr size_t pinLength = 240; // frames
    struct Pin {
        glm::ivec2 texel{0};
        std::array<std::array<float, pinLength>, 4> values;
        size_t count = 0, next = 0;
        uint64_t frame = 0; // of the last value
    };
    struct Frozen {
        Texture texture;
        uint64_t frame;
    };
    // What decides the texels that are looked at.
    struct Version {
        uint64_t frame = 0;
        const Texture* texture = nullptr;
        int layer = 0, level = 0, sample = 0;
        bool operator==(const Version&) const = default;
    };

    Source source() const;
    void measure(Inspector& inspector, double share);
    void settleRange();
    void followPin(Inspector& inspector);
    const float* texelUnder(Inspector& inspector, glm::ivec2 texel);

    void navigate(Sight& sight, Events& events, ImVec2 corner, ImVec2 size, double unitsPerTexel);
    void paint(Inspector& inspector, ImVec2 size, float pixelsPerUnit);
    void printValues(Inspector& inspector, ImVec2 corner, ImVec2 size, double unitsPerTexel);
    void drawPictureEdge(ImVec2 corner, double unitsPerTexel) const;
    void drawPlace(ImVec2 corner, glm::ivec2 texel, double unitsPerTexel, ImU32 ink) const;
    void caption(std::optional<glm::ivec2> texel, float width, bool chosen);

    void imageRows();
    void kindRows() const;
    void rangeRows(Inspector& inspector);
    void markRows(Sight& sight);
    void valueTable();
    void pinRows();
    std::optional<BufferShot> keepRow(Inspector& inspector, const Sight& sight);
    BufferShot shotAsSeen(Inspector& inspector, const Sight& sight) const;
    BufferShot shotRaw(Inspector& inspector) const;

    std::string label_;
    ImageSpec spec_;
    glm::ivec2 margin_{0};             // texels beyond each edge of the picture
    const Texture* texture_ = nullptr; // of this frame; null: the image is not there
    std::optional<Frozen> frozen_;
    bool freeze_ = false;
    Version version_;
    std::string trouble_; // why it cannot be looked at

    int layer_ = 0, level_ = 0, sample_ = 0;
    Look look_;
    RangeMode mode_ = RangeMode::Automatic;
    ValueRange typed_, automatic_;
    std::array<float, 2> entered_{}; // into the fields of the range, until they are left
    Statistics statistics_;
    Histogram histogram_;
    std::optional<Version> measured_; // what the statistics are of; none: look at once
    int turn_ = 0;                    // of the measuring that are done
    double nextMeasuring_ = 0;        // ImGui's time [s]

    // What the painted texture was made from.
    struct Painted {
        Version version;
        Look look;
        ImageWindow window;
        glm::ivec2 size{0};
        bool operator==(const Painted&) const = default;
    };
    Painted painted_;
    Texture painting_;
    ImageWindow window_;  // what is seen
    double fitScale_ = 0; // pixels of the screen per texel where all of it fits

    std::optional<glm::ivec2> pointed_;
    struct Fetched {
        Version version;
        glm::ivec2 corner{0}, size{0};
        std::vector<float> values;
        bool fresh(const Version& wanted, glm::ivec2 from, glm::ivec2 extent) const {
            return version == wanted && corner == from && size == extent;
        }
    };
    Fetched underPointer_, printed_;
    std::optional<Pin> pin_;
    std::vector<float> pinValues_;
};

} // namespace penumbra
