// SPDX-License-Identifier: MIT
#include "renderer/inspect/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

using glm::ivec2;

// The texels of an image that tell of a pixel: its own, or all of a row.
struct Texels {
    ivec2 corner{0};
    int count = 0;
};
Texels texelsOf(const Extent& extent, ivec2 pictureSize, ivec2 pixel) {
    const ivec2 size(extent.width, extent.height);
    if (glm::all(glm::greaterThanEqual(size, pictureSize))) return {pixel + (size - pictureSize) / 2, 1};
    return {{0, 0}, size.y == 1 ? size.x : 0};
}

} // namespace

Probe::Flights::~Flights() {
    for (Flight& flight : *this)
        if (flight.fence) glDeleteSync(flight.fence);
}

void Probe::forget() {
    for (Flight& flight : flights_)
        if (flight.fence) glDeleteSync(std::exchange(flight.fence, nullptr));
    samples_.clear();
    row_.clear();
}

void Probe::follow(glm::dvec2 place) {
    place_ = glm::clamp(place, 0.0, std::nextafter(1.0, 0.0));
    forget();
}

void Probe::letGo() {
    place_.reset();
    forget();
}

std::optional<ivec2> Probe::pixel(ivec2 pictureSize) const {
    if (!place_) return std::nullopt;
    const ivec2 fromAbove(glm::floor(*place_ * glm::dvec2(pictureSize)));
    return ivec2(fromAbove.x, pictureSize.y - 1 - fromAbove.y);
}

void Probe::prepare(std::span<const ProbePlot> plots, std::string_view owner) {
    if (plots_ == plots.data() && owner_ == owner) return;
    forget();
    plots_ = plots.data();
    owner_ = owner;
    sources_.clear();
    for (const ProbePlot& plot : plots)
        for (const ProbeSeries& series : plot.series) {
            const size_t dot = series.channel.find('.');
            sources_.push_back({owner_ + "." + std::string(series.channel.substr(0, dot)),
                                series.channel.substr(dot + 1),
                                plot.kind == ProbePlot::Kind::Around || plot.kind == ProbePlot::Kind::Curves});
        }
}

void Probe::look(const Renderer& renderer, std::span<const ProbePlot> plots, std::string_view owner) {
    prepare(plots, owner);
    const ivec2 size = renderer.view().size;
    if (size != std::exchange(size_, size)) forget();
    const std::optional<ivec2> pixel = this->pixel(size);
    if (!pixel || renderer.inspected().probe != pixel || sources_.empty()) return;
    Flight& flight = flights_[next_];
    next_ = (next_ + 1) % flights_.size();
    if (flight.fence) { // the oldest; a gap is better than a wait
        glDeleteSync(std::exchange(flight.fence, nullptr));
    }
    const Flow& flow = renderer.flow();
    flight.frame = std::max(flow.historyLength(), 1);
    flight.reads.clear();
    size_t floats = 0;
    struct Fetch {
        const Texture* texture;
        Texels texels;
        size_t offset;
    };
    FixedVector<Fetch, 16> fetches;
    for (const Source& source : sources_) {
        const std::optional<Image> image = flow.find(source.label);
        Read read;
        if (image) {
            const ImageSpec& spec = flow.spec(*image);
            const Texels texels = texelsOf(spec.extent, size, *pixel);
            const Texture* texture = &renderer.runner().texture(flow, *image);
            read.stride = static_cast<size_t>(info(spec.format).channels);
            auto known =
                std::find_if(fetches.begin(), fetches.end(), [&](const Fetch& f) { return f.texture == texture; });
            if (known == fetches.end()) {
                fetches.push_back({texture, texels, floats});
                known = fetches.end() - 1;
                floats += read.stride * static_cast<size_t>(texels.count);
            }
            const auto channel = std::find_if(spec.channels.begin(), spec.channels.end(),
                                              [&](const Channel& c) { return c.name == source.channel; });
            ensure(channel != spec.channels.end(), "a probe plots a channel that there is not");
            read.offset = known->offset + static_cast<size_t>(channel - spec.channels.begin());
            read.count = static_cast<size_t>(texels.count);
        }
        flight.reads.push_back(read);
    }
    if (floats == 0) return;
    if (flight.buffer.bytes() < floats * sizeof(float))
        flight.buffer = Buffer("probe", floats * sizeof(float), nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, flight.buffer.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (const Fetch& fetch : fetches) {
        const GlFormat format = glFormat(fetch.texture->format());
        const size_t at = fetch.offset * sizeof(float);
        glGetTextureSubImage(fetch.texture->name(), 0, fetch.texels.corner.x, fetch.texels.corner.y, 0,
                             fetch.texels.count, 1, 1, format.layout, GL_FLOAT,
                             static_cast<GLsizei>(flight.buffer.bytes() - at), reinterpret_cast<void*>(at));
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    flight.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
}

void Probe::take() {
    for (size_t i = 0; i < flights_.size(); ++i) { // the oldest first
        Flight& flight = flights_[(next_ + i) % flights_.size()];
        if (!flight.fence) continue;
        if (glClientWaitSync(flight.fence, 0, 0) == GL_TIMEOUT_EXPIRED) return;
        glDeleteSync(std::exchange(flight.fence, nullptr));
        land(flight);
    }
}

void Probe::land(Flight& flight) {
    const void* mapped =
        glMapNamedBufferRange(flight.buffer.name(), 0, static_cast<GLsizeiptr>(flight.buffer.bytes()), GL_MAP_READ_BIT);
    ensure(mapped, "a buffer that was read back cannot be mapped");
    const float* values = static_cast<const float*>(mapped);
    Sample sample{flight.frame, {}};
    sample.values.fill(std::numeric_limits<float>::quiet_NaN());
    size_t column = 0;
    row_.clear();
    for (size_t texel = 0, most = 1; texel < most; ++texel)
        for (size_t i = 0; i < sources_.size(); ++i) {
            const Read& read = flight.reads[i];
            if (!sources_[i].ofRow || read.count == 0) continue;
            most = read.count;
            row_.push_back(values[read.offset + texel * read.stride]);
        }
    for (size_t i = 0; i < sources_.size(); ++i) {
        if (sources_[i].ofRow) continue;
        if (flight.reads[i].count > 0) sample.values[column] = values[flight.reads[i].offset];
        ++column;
    }
    glUnmapNamedBuffer(flight.buffer.name());
    // The same frame again, or a history that began anew.
    while (!samples_.empty() && samples_.back().frame >= sample.frame) samples_.pop_back();
    if (samples_.size() >= 2 * mostSamples)
        samples_.erase(samples_.begin(), samples_.end() - static_cast<std::ptrdiff_t>(mostSamples));
    samples_.push_back(sample);
}

} // namespace penumbra
