// SPDX-License-Identifier: MIT
#include "renderer/inspect/inspector.h"

#include "renderer/gl/debug.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

using glm::ivec2;

int groups(int texels, int groupSide) { return (texels + groupSide - 1) / groupSide; }

SourceBlock sourceBlock(const Source& source, int channel) {
    const ivec2 size = source.size();
    const int channels = info(source.texture.format()).channels;
    SourceBlock block{
        ivec4(source.layer, source.texture.extent().samples > 1 ? source.sample : source.level, size.x, size.y),
        ivec4(channel, channel, channel, channels), vec4(0), vec4(0)};
    if (channel < 0) block.channels = ivec4(0, 1, 2, channels);
    for (int i = 0; i < shownChannels; ++i) {
        const size_t shown = static_cast<size_t>(block.channels[i]);
        if (shown >= source.channels.size()) continue;
        block.statedLow[i] = source.channels[shown].min;
        block.statedHigh[i] = source.channels[shown].max;
    }
    return block;
}

} // namespace

ivec2 Source::size() const {
    const Extent& extent = texture.extent();
    return {std::max(extent.width >> level, 1), std::max(extent.height >> level, 1)};
}

Inspector::Inspector(ProgramLibrary& programs)
    : programs_(programs)
    , constants_("inspect.constants", 256, nullptr, GL_DYNAMIC_STORAGE_BIT)
    , samples_("inspect.samples", sizeof(float) * shownChannels * sampleSide * sampleSide, nullptr, 0)
    , measured_("inspect.measured", sizeof(MeasuredBlock), nullptr, GL_DYNAMIC_STORAGE_BIT) {
    values_.reserve(shownChannels * sampleSide * sampleSide);
}

const Program& Inspector::program(const char* shader, const Source& source, Defines defines) {
    if (source.texture.extent().samples > 1)
        defines.push_back({"MULTISAMPLED"});
    else if (source.texture.extent().layers > 1)
        defines.push_back({"ARRAY"});
    if (info(source.texture.format()).whole) defines.push_back({"WHOLE"});
    return programs_.get(ProgramKind::Compute, shader, defines, nullptr);
}

template <class Block>
void Inspector::dispatch(const Program& program, const Source& source, const Block& block, int groupsX, int groupsY) {
    constants_.update(0, sizeof(block), &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, constants_.name());
    glBindTextureUnit(0, source.texture.name());
    glBindSampler(0, 0);
    glUseProgram(program.name());
    glDispatchCompute(static_cast<GLuint>(groupsX), static_cast<GLuint>(groupsY), 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                    GL_SHADER_STORAGE_BARRIER_BIT);
}

void Inspector::paint(const Source& source, const Look& look, const ImageWindow& window, const Texture& target,
                      ivec2 corner, ivec2 size) {
    const DebugGroup group("inspect.paint");
    const PaintBlock block{sourceBlock(source, look.channel),
                           {window.left, window.top, window.texelsPerPixel, 0},
                           {look.range.min, look.range.max, look.channel < 0 ? 0.0f : static_cast<float>(look.map),
                            static_cast<float>(look.marks)},
                           {corner, size}};
    const Program& paint = program("inspect/paint.glsl", source);
    glBindImageTexture(0, target.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, glFormat(target.format()).internal);
    dispatch(paint, source, block, groups(size.x, 8), groups(size.y, 8));
}

Picture Inspector::picture(const Source& source, const Look& look, const ImageWindow& window, ivec2 size) {
    const Texture target("inspect.picture", Format::RGBA8, {.width = size.x, .height = size.y});
    paint(source, look, window, target, {0, 0}, size);
    const std::vector<float> rgba = target.read(); // its first row is the upper one
    Picture picture{size.x, size.y, {"R", "G", "B"}, {}};
    picture.values.reserve(rgba.size() / 4 * 3);
    for (auto texel = rgba.begin(); texel != rgba.end(); texel += 4)
        picture.values.insert(picture.values.end(), texel, texel + 3);
    return picture;
}

std::optional<ValueRange> Inspector::range(const Source& source, int channel) {
    const DebugGroup group("inspect.sample");
    const ivec2 size = source.size(), cells = glm::min(size, ivec2(sampleSide));
    const SampleBlock block{sourceBlock(source, channel), ivec4(cells, 0, 0)};
    const Program& sample = program("inspect/sample.glsl", source);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, samples_.name());
    dispatch(sample, source, block, groups(cells.x, 8), groups(cells.y, 8));
    const size_t count = static_cast<size_t>(cells.x) * static_cast<size_t>(cells.y);
    const size_t channels = channel < 0 ? shownChannels : 1;
    values_.resize(channels * count);
    glGetNamedBufferSubData(samples_.name(), 0, static_cast<GLsizeiptr>(values_.size() * sizeof(float)),
                            values_.data());
    std::optional<ValueRange> all;
    for (size_t c = 0; c < channels; ++c)
        if (const auto own = quantileRange(std::span(values_).subspan(c * count, count)))
            all = all ? hull(*all, *own) : *own;
    return all;
}

namespace {
// Every how many-th texel of how many-th row one turn looks at.
int latticeStep(const Source& source) {
    const ivec2 size = source.size();
    const double texels = static_cast<double>(size.x) * size.y;
    return static_cast<int>(std::ceil(std::sqrt(texels / Inspector::mostTexelsAtOnce)));
}
} // namespace

int Inspector::turns(const Source& source) { return latticeStep(source) * latticeStep(source); }

void Inspector::measure(const Source& source, int channel, ValueRange domain, int turn, Statistics& statistics) {
    const DebugGroup group("inspect.measure");
    const ivec2 size = source.size();
    const int channels = channel < 0 ? shownChannels : 1, step = latticeStep(source);
    if (turn == 0) statistics = Statistics(channels, domain, size);
    const MeasuredBlock none = Statistics().measured;
    measured_.update(0, sizeof(none), &none);
    const MeasureBlock block{sourceBlock(source, channel), ivec4(step, turn % step, turn / step, 0),
                             vec4(statistics.domain.min, statistics.domain.max, 0, 0)};
    const Program& measure = program("inspect/measure.glsl", source, {{"CHANNELS", channels}});
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, measured_.name());
    constexpr int texelsPerGroup = 64;
    dispatch(measure, source, block, groups(groups(size.x, step), texelsPerGroup),
             groups(groups(size.y, step), texelsPerGroup));
    MeasuredBlock measured;
    glGetNamedBufferSubData(measured_.name(), 0, sizeof(measured), &measured);
    statistics.add(measured);
}

void Inspector::read(const Source& source, ivec2 corner, ivec2 size, std::vector<float>& values) {
    const size_t channels = static_cast<size_t>(info(source.texture.format()).channels);
    const ivec2 whole = source.size();
    ensure(glm::all(glm::greaterThanEqual(corner, ivec2(0))) && glm::all(glm::lessThanEqual(corner + size, whole)),
           "texels beyond the image");
    const size_t row = static_cast<size_t>(size.x) * channels;
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    if (source.texture.extent().samples > 1) {
        const DebugGroup group("inspect.copy");
        struct {
            SourceBlock source;
            ivec4 rectangle;
        } const block{sourceBlock(source, 0), ivec4(corner, size)};
        if (!copied_.name() || copied_.extent().width < size.x || copied_.extent().height < size.y)
            copied_ = Texture("inspect.copied", Format::RGBA32F, {.width = size.x, .height = size.y});
        const Program& copy = program("inspect/copy.glsl", source);
        glBindImageTexture(0, copied_.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        dispatch(copy, source, block, groups(size.x, 8), groups(size.y, 8));
        values.resize(row / channels * 4 * static_cast<size_t>(size.y));
        glGetTextureSubImage(copied_.name(), 0, 0, 0, 0, size.x, size.y, 1, GL_RGBA, GL_FLOAT,
                             static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
        for (size_t i = 0; i < row / channels * static_cast<size_t>(size.y); ++i)
            std::copy_n(values.begin() + static_cast<ptrdiff_t>(4 * i), channels,
                        values.begin() + static_cast<ptrdiff_t>(channels * i));
        values.resize(row * static_cast<size_t>(size.y));
        return;
    }
    const GlFormat format = glFormat(source.texture.format());
    values.resize(row * static_cast<size_t>(size.y));
    glGetTextureSubImage(source.texture.name(), source.level, corner.x, whole.y - corner.y - size.y, source.layer,
                         size.x, size.y, 1, format.layout, format.type,
                         static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    toFloats(source.texture.format(), values);
    for (auto low = values.begin(), high = values.end() - static_cast<ptrdiff_t>(row); low < high;
         low += static_cast<ptrdiff_t>(row), high -= static_cast<ptrdiff_t>(row))
        std::swap_ranges(low, low + static_cast<ptrdiff_t>(row), high);
}

} // namespace penumbra
