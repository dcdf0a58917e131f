// SPDX-License-Identifier: MIT
// What both sides know of the passes that look into an image. Compiled by C++ (renderer/shared.h) and by GLSL.

const int histogramBins = 256; // even steps over the domain
const int markCount = 4;       // NaN, infinite, negative, out of the stated range
const int shownChannels = 3;
const int sampleSide = 128; // at most sampleSide² texels are looked at for quantiles

// One layer and level, or one sample, of an image; and which of its channels. Rows of 16 bytes.
struct SourceBlock {
    ivec4 place;     // x = layer, y = mip level, or the sample of a multisampled image, zw = its size [texels]
    ivec4 channels;  // shown as red, green, blue; three times the same one: a single channel; w = how many it has
    vec4 statedLow;  // per shown channel; none is stated where the low end is not below the high one
    vec4 statedHigh; // w unused
};

struct PaintBlock {
    SourceBlock source;
    vec4 window;          // xy = texel at the view's corner, from the upper left; z = texels per pixel
    vec4 range_map_marks; // xy = values at the colours' ends, z = ColourMap, w = sum of 1 << mark of those to be painted
    ivec4 target;         // xy = its upper left pixel, zw = its size
};

struct MeasureBlock {
    SourceBlock source;
    ivec4 lattice; // every x-th texel of every x-th row, from (y, z) on
    vec4 domain;   // xy = ends of the histogram
};

struct SampleBlock {
    SourceBlock source;
    ivec4 cells; // xy = how many of them across and down, each of which gives one texel
};

// Counted on the GPU; in a storage buffer of std430, all words.
struct MeasuredBlock {
    uint looked;               // texels
    uint elsewhere;            // of them: NaN or infinite in a channel that is not shown
    uint count[markCount];     // of them: with the mark in a shown channel
    uint first[markCount];     // the least texel index row · width + column from the upper left, or ~0
    uint least[shownChannels]; // keys of the finite values
    uint most[shownChannels];
    uint below[shownChannels]; // finite values below the domain
    uint above[shownChannels];
    uint bins[shownChannels * histogramBins];
};
