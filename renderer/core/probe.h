// SPDX-License-Identifier: MIT
// What a technique has to tell of one pixel: plots of numbers that stand in images of its own. Who draws them knows no
// technique; see Technique::probePlots().
#pragma once

#include <span>
#include <string_view>

namespace penumbra {

// A channel of an image, "shadow-buffer.n": the probed pixel's texel of an image that is as large as the picture or the
// geometry buffer, every texel of the only row of another one, which a technique writes for Inputs::inspection.probe.
enum class ProbeMark {
    Line, // joins the values
    Dots,
    Band,    // half as wide as twice the value around the line before
    Dashed,  // joins the values as well
    Heavy,   // and so, what matters most
    Step,    // holds each value until the next
    Upright, // of curves: a line from top to bottom at the first value
};
struct ProbeSeries {
    std::string_view channel;
    std::string_view name; // a symbol or a word or two
    ProbeMark mark = ProbeMark::Line;
};

struct ProbePlot {
    enum class Kind {
        Course, // every series over the frames of the history; the truth lies across
        Places, // of each frame a dot at the first two series, in [−1, 1]²; filled where the third is 1
        Around, // of one frame: dots over the view, around the pixel, at the first two series [pixels], by the third:
                // 1 counts, 0 does not, negative is none
        Curves, // of one frame: over the values of the first series those of the others
    };
    Kind kind = Kind::Course;
    std::string_view title, help;
    std::span<const ProbeSeries> series;   // static
    std::string_view across = {}, up = {}; // the axes of curves
};

} // namespace penumbra
