// SPDX-License-Identifier: MIT
// Looks into images on the GPU: counts what is in them, paints them as colours, fetches a few texels. Only small
// results are read back. Texels are counted from the upper left corner, rows downwards.
#pragma once

#include "renderer/core/picture.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/inspect/statistics.h"

#include <vector>

namespace penumbra {

// One layer and mip level of an image, or one sample of a multisampled one, and what its channels mean.
struct Source {
    const Texture& texture;
    std::span<const Channel> channels;
    int layer = 0, level = 0, sample = 0;

    glm::ivec2 size() const;
};

class Inspector {
public:
    explicit Inspector(ProgramLibrary& programs);

    // Paints what `window` shows into the rectangle of an RGBA8 target; transparent outside of the image. The target's
    // first row becomes the upper one.
    void paint(const Source& source, const Look& look, const ImageWindow& window, const Texture& target,
               glm::ivec2 corner, glm::ivec2 size);

    // What `window` shows in a picture of its own, upper row first: R, G and B in [0, 1], black outside of the image.
    // Stalls.
    Picture picture(const Source& source, const Look& look, const ImageWindow& window, glm::ivec2 size);

    // The automatic range of a channel (−1: of the first three), from at most 16384 texels spread over the image; none
    // without finite values. Stalls.
    std::optional<ValueRange> range(const Source& source, int channel);

    // Counts at most `mostTexelsAtOnce` texels, spread evenly over the image. A larger image needs several turns, which
    // add up: `turn` goes from 0 to turns() − 1, after which the statistics are complete. Stalls.
    void measure(const Source& source, int channel, ValueRange domain, int turn, Statistics& statistics);
    static constexpr int64_t mostTexelsAtOnce = 1 << 20;
    static int turns(const Source& source);

    // `channels` floats a texel of a rectangle that lies within the image. Stalls.
    void read(const Source& source, glm::ivec2 corner, glm::ivec2 size, std::vector<float>& values);

private:
    const Program& program(const char* shader, const Source& source, Defines defines = {});
    template <class Block>
    void dispatch(const Program& program, const Source& source, const Block& block, int groupsX, int groupsY);

    ProgramLibrary& programs_;
    Buffer constants_, samples_, measured_;
    std::vector<float> values_;
    Texture copied_; // of a multisampled image
};

} // namespace penumbra
