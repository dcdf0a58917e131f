// SPDX-License-Identifier: MIT
// What an image is: its format, its size, and what each of its channels means to a person.
#pragma once

#include "renderer/core/parameters.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace penumbra {

enum class Format : uint8_t {
    RGBA8,
    RG16,
    RGBA16,
    RGBA16Snorm,
    R16F,
    RG16F,
    RGBA16F,
    R32F,
    RG32F,
    RGBA32F,
    Depth32F,
    RG32UI,
    RGBA32UI
};

struct FormatInfo {
    std::string_view name; // as OpenGL calls it, without the prefix
    int channels;
    int bytesPerTexel;
    bool whole = false; // of unsigned whole numbers, which shaders read through a usampler
};
const FormatInfo& info(Format format);

struct Extent {
    int width = 1, height = 1, layers = 1, levels = 1, samples = 1;
    bool operator==(const Extent&) const = default;
};

// What a channel holds. The range is the one to look at it in; min == max: automatic.
struct Channel {
    std::string_view name; // lower case, ends a label: "shadow-buffer.rho"
    std::string_view symbol = {};
    std::string_view meaning;
    Unit unit = Unit::None;
    float min = 0, max = 0;
    std::span<const std::string_view> names = {}; // of the whole numbers from 0 on, where they are kinds of something
};

struct ImageSpec {
    std::string_view name; // kebab-case
    Format format = Format::RGBA8;
    Extent extent = {};
    std::span<const Channel> channels = {}; // static; one per channel that means something

    // Two descriptions are equal if the same texture can hold both.
    bool sameStorage(const ImageSpec& other) const { return format == other.format && extent == other.extent; }
    uint64_t bytes() const;
};

} // namespace penumbra
