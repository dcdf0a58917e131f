// SPDX-License-Identifier: MIT
// Follows one pixel of the picture from frame to frame: the numbers that Technique::probePlots() names. They are read
// back without a wait and come a few frames late.
#pragma once

#include "renderer/renderer.h"

#include <array>
#include <string>

namespace penumbra {

class Probe {
public:
    static constexpr size_t mostSamples = 2000; // the newest are kept

    // A place of the picture, from its upper left corner, in [0, 1]².
    void follow(glm::dvec2 place);
    void letGo();
    bool following() const { return place_.has_value(); }
    glm::dvec2 place() const { return place_.value(); }
    // From the picture's lower left corner.
    std::optional<glm::ivec2> pixel(glm::ivec2 pictureSize) const;

    // Reads the frame that was finished last, if it was looked into at this pixel. `owner`: the front of the
    // technique's labels, "a/temporal".
    void look(const Renderer& renderer, std::span<const ProbePlot> plots, std::string_view owner);
    // Takes what has come.
    void take();

    // One value a series of the Course and Places plots, in their order; NaN: it was not there.
    struct Sample {
        int frame; // of the history, from 1 on
        std::array<float, 12> values;
    };
    const std::vector<Sample>& samples() const { return samples_; }
    // Of the plot that a row tells, around the pixel or of curves: its series, one after the other for every texel.
    const std::vector<float>& row() const { return row_; }

private:
    // Where a series stands among what is read.
    struct Source {
        std::string label; // of the image
        std::string_view channel;
        bool ofRow;
    };
    struct Read {                                 // of a source, in floats
        size_t offset = 0, stride = 0, count = 0; // count 0: it is not there
    };
    struct Flight {
        Buffer buffer;
        GLsync fence = nullptr;
        int frame = 0;
        FixedVector<Read, 16> reads;
    };

    void prepare(std::span<const ProbePlot> plots, std::string_view owner);
    void land(Flight& flight);
    void forget();

    struct Flights : std::array<Flight, 4> { // frames on their way
        ~Flights();
    };
    std::optional<glm::dvec2> place_;
    glm::ivec2 size_{0}; // of the picture
    const ProbePlot* plots_ = nullptr;
    std::string owner_;
    std::vector<Source> sources_;
    Flights flights_;
    size_t next_ = 0;
    std::vector<Sample> samples_;
    std::vector<float> row_;
};

} // namespace penumbra
