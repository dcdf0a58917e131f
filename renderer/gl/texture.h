// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/core/flow.h"
#include "renderer/gl/handle.h"

#include <span>
#include <string_view>
#include <vector>

namespace penumbra {

// Immutable storage of one image, labelled. Two-dimensional, an array where it has layers.
class Texture {
public:
    Texture() = default;
    // Throws InputError if the driver's size limit is exceeded or it does not offer that number of samples. An image of
    // several samples has one layer and one level, and cannot be read back or cleared.
    Texture(std::string_view label, Format format, Extent extent);

    GLuint name() const { return handle_.get(); }
    GLenum target() const {
        return extent_.samples > 1  ? GL_TEXTURE_2D_MULTISAMPLE
               : extent_.layers > 1 ? GL_TEXTURE_2D_ARRAY
                                    : GL_TEXTURE_2D;
    }
    Format format() const { return format_; }
    const Extent& extent() const { return extent_; }

    void clear(); // all zero
    // A texture of the same storage and texels.
    Texture copy(std::string_view label) const;
    // All texels of a layer and level as floats, `channels` a texel, row 0 first as OpenGL has it. Stalls.
    std::vector<float> read(int layer = 0, int level = 0) const;
    // The first channel of one texel, (0, 0) being the first of the first row. Stalls too.
    float readTexel(int x, int y) const;

private:
    static void destroy(GLuint name) { glDeleteTextures(1, &name); }
    Handle<destroy> handle_;
    Format format_ = Format::RGBA8;
    Extent extent_;
};

struct GlFormat {
    GLenum internal, layout, type; // layout and type: as it is cleared and read back, in floats or whole numbers
};
GlFormat glFormat(Format format);
// Turns texels that were read back into floats, the nearest ones to whole numbers.
void toFloats(Format format, std::span<float> readBack);

// The sampler objects of enum Sampling, made once for a context.
class Samplers {
public:
    Samplers();
    GLuint get(Sampling sampling, int anisotropy = 1) const {
        const auto number = static_cast<size_t>(sampling);
        return anisotropy > 1 ? anisotropic_[static_cast<size_t>(anisotropy)].get() : handles_[number].get();
    }
    static constexpr int mostAnisotropy = 16;

private:
    static void destroy(GLuint name) { glDeleteSamplers(1, &name); }
    Handle<destroy> handles_[4];
    Handle<destroy> anisotropic_[mostAnisotropy + 1]; // LinearMipmap, from 2 on
};

} // namespace penumbra
