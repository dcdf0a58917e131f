// SPDX-License-Identifier: MIT
#include "renderer/gl/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace penumbra {

GlFormat glFormat(Format format) {
    static constexpr GlFormat table[] = {
        {GL_RGBA8, GL_RGBA, GL_FLOAT},
        {GL_RG16, GL_RG, GL_FLOAT},
        {GL_RGBA16, GL_RGBA, GL_FLOAT},
        {GL_RGBA16_SNORM, GL_RGBA, GL_FLOAT},
        {GL_R16F, GL_RED, GL_FLOAT},
        {GL_RG16F, GL_RG, GL_FLOAT},
        {GL_RGBA16F, GL_RGBA, GL_FLOAT},
        {GL_R32F, GL_RED, GL_FLOAT},
        {GL_RG32F, GL_RG, GL_FLOAT},
        {GL_RGBA32F, GL_RGBA, GL_FLOAT},
        {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT},
        {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT},
        {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
    };
    return table[static_cast<size_t>(format)];
}

void toFloats(Format format, std::span<float> readBack) {
    if (!info(format).whole) return;
    for (float& value : readBack) value = static_cast<float>(std::bit_cast<uint32_t>(value));
}

Texture::Texture(std::string_view label, Format format, Extent extent) : format_(format), extent_(extent) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (extent.width > limit || extent.height > limit)
        throw InputError(fmt::format("{}: {}x{} texels are more than this driver's limit of {}x{}", label, extent.width,
                                     extent.height, limit, limit));
    if (extent.samples > 1) {
        GLint counts[16] = {}, found = 0;
        const GLenum internal = glFormat(format).internal;
        glGetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, internal, GL_NUM_SAMPLE_COUNTS, 1, &found);
        found = std::min<GLint>(found, std::size(counts));
        glGetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, internal, GL_SAMPLES, found, counts);
        if (std::find(counts, counts + found, extent.samples) == counts + found)
            throw InputError(fmt::format("{}: {} samples a texel of {}; this driver offers {}", label, extent.samples,
                                         info(format).name, fmt::join(counts, counts + found, ", ")));
    }
    GLuint name = 0;
    glCreateTextures(target(), 1, &name);
    handle_ = Handle<destroy>(name);
    const GLenum internal = glFormat(format).internal;
    if (extent.samples > 1)
        glTextureStorage2DMultisample(name, extent.samples, internal, extent.width, extent.height, GL_TRUE);
    else if (extent.layers > 1)
        glTextureStorage3D(name, extent.levels, internal, extent.width, extent.height, extent.layers);
    else
        glTextureStorage2D(name, extent.levels, internal, extent.width, extent.height);
    if (info(format).whole) { // without a sampler they can be read by texel only if nothing would be interpolated
        glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    glObjectLabel(GL_TEXTURE, name, static_cast<GLsizei>(label.size()), label.data());
}

void Texture::clear() {
    static constexpr float zero[4] = {};
    const GlFormat gl = glFormat(format_);
    for (int level = 0; level < extent_.levels; ++level) glClearTexImage(name(), level, gl.layout, gl.type, zero);
}

Texture Texture::copy(std::string_view label) const {
    Texture twin(label, format_, extent_);
    for (int level = 0; level < extent_.levels; ++level)
        glCopyImageSubData(name(), target(), level, 0, 0, 0, twin.name(), target(), level, 0, 0, 0,
                           std::max(extent_.width >> level, 1), std::max(extent_.height >> level, 1), extent_.layers);
    return twin;
}

std::vector<float> Texture::read(int layer, int level) const {
    ensure(extent_.samples == 1, "an image of several samples cannot be read back");
    const int width = std::max(extent_.width >> level, 1), height = std::max(extent_.height >> level, 1);
    const GlFormat gl = glFormat(format_);
    std::vector<float> values(static_cast<size_t>(width) * height * info(format_).channels);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureSubImage(name(), level, 0, 0, layer, width, height, 1, gl.layout, gl.type,
                         static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    toFloats(format_, values);
    return values;
}

float Texture::readTexel(int x, int y) const {
    ensure(extent_.samples == 1, "an image of several samples cannot be read back");
    float values[4] = {};
    const GlFormat gl = glFormat(format_);
    glGetTextureSubImage(name(), 0, x, y, 0, 1, 1, 1, gl.layout, gl.type, sizeof(values), values);
    return values[0];
}

Samplers::Samplers() {
    static constexpr std::string_view labels[] = {"nearest", "linear", "linear mipmap", "compare"};
    const auto make = [](Sampling sampling) {
        GLuint name = 0;
        glCreateSamplers(1, &name);
        const GLint filter = sampling == Sampling::Nearest ? GL_NEAREST : GL_LINEAR;
        glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
        glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER,
                            sampling == Sampling::LinearMipmap ? GL_LINEAR_MIPMAP_LINEAR : filter);
        glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        if (sampling == Sampling::Compare) {
            glSamplerParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
            glSamplerParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
        }
        const std::string_view label = labels[static_cast<size_t>(sampling)];
        glObjectLabel(GL_SAMPLER, name, static_cast<GLsizei>(label.size()), label.data());
        return Handle<destroy>(name);
    };
    for (size_t i = 0; i < std::size(handles_); ++i) handles_[i] = make(static_cast<Sampling>(i));
    for (int i = 2; i <= mostAnisotropy; ++i) {
        anisotropic_[i] = make(Sampling::LinearMipmap);
        glSamplerParameterf(anisotropic_[i].get(), GL_TEXTURE_MAX_ANISOTROPY, static_cast<float>(i));
    }
}

} // namespace penumbra
