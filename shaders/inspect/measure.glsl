// SPDX-License-Identifier: MIT
// Counts an image: marks, extremes, and a histogram of each shown channel. A group of 256 looks at 64x64 texels and
// adds up in its own memory first, so that an image of one value does not queue at one bin.
#include "inspect/source.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(std140, binding = 0) uniform Constants { MeasureBlock measure; };
layout(std430, binding = 0) buffer Result { MeasuredBlock result; };

#ifndef CHANNELS
#define CHANNELS 1
#endif
const int texelsPerSide = 4; // of an invocation
const uint groupSize = gl_WorkGroupSize.x * gl_WorkGroupSize.y;

shared uint bins[CHANNELS * histogramBins];
shared uint least[CHANNELS], most[CHANNELS], below[CHANNELS], above[CHANNELS];
shared uint counts[markCount], firsts[markCount], elsewhere, looked;

// Greater numbers have greater keys.
uint keyOf(float v)
{
    uint bits = floatBitsToUint(v);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void add(int channel, float v)
{
    if (isNotANumber(v) || isInfinite(v)) return;
    uint key = keyOf(v);
    atomicMin(least[channel], key);
    atomicMax(most[channel], key);
    if (v < measure.domain.x)
        atomicAdd(below[channel], 1u);
    else if (v > measure.domain.y)
        atomicAdd(above[channel], 1u);
    else {
        float bin = placeIn(v, measure.domain.x, measure.domain.y) * float(histogramBins);
        atomicAdd(bins[channel * histogramBins + clamp(int(bin), 0, histogramBins - 1)], 1u);
    }
}

void look(ivec2 texel)
{
    vec4 value = sourceTexel(measure.source.place, texel);
    vec3 v = shown(value, measure.source.channels);
    uint marks = marksOf(v, measure.source);
    uint index = uint(texel.y * measure.source.place.z + texel.x);
    atomicAdd(looked, 1u);
    for (int i = 0; marks != 0u && i < markCount; ++i)
        if ((marks & (1u << i)) != 0u) {
            atomicAdd(counts[i], 1u);
            atomicMin(firsts[i], index);
        }
    bool bad = false;
    for (int i = 0; i < measure.source.channels.w; ++i)
        if (all(notEqual(ivec3(i), measure.source.channels.xyz)))
            bad = bad || isNotANumber(value[i]) || isInfinite(value[i]);
    if (bad) atomicAdd(elsewhere, 1u);
    for (int i = 0; i < CHANNELS; ++i) add(i, v[i]);
}

void main()
{
    uint me = gl_LocalInvocationIndex;
    for (uint i = me; i < uint(CHANNELS * histogramBins); i += groupSize) bins[i] = 0u;
    if (me < uint(CHANNELS)) {
        least[me] = ~0u;
        most[me] = below[me] = above[me] = 0u;
    }
    if (me < uint(markCount)) {
        counts[me] = 0u;
        firsts[me] = ~0u;
    }
    if (me == 0u) elsewhere = looked = 0u;
    barrier();

    ivec2 corner = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) * texelsPerSide + ivec2(gl_LocalInvocationID.xy);
    for (int y = 0; y < texelsPerSide; ++y)
        for (int x = 0; x < texelsPerSide; ++x) {
            ivec2 place = corner + ivec2(x, y) * ivec2(gl_WorkGroupSize.xy);
            ivec2 texel = place * measure.lattice.x + measure.lattice.yz;
            if (all(lessThan(texel, measure.source.place.zw))) look(texel);
        }
    barrier();

    for (uint i = me; i < uint(CHANNELS * histogramBins); i += groupSize)
        if (bins[i] != 0u) atomicAdd(result.bins[i], bins[i]);
    if (me < uint(CHANNELS)) {
        atomicMin(result.least[me], least[me]);
        atomicMax(result.most[me], most[me]);
        atomicAdd(result.below[me], below[me]);
        atomicAdd(result.above[me], above[me]);
    }
    if (me < uint(markCount) && counts[me] != 0u) {
        atomicAdd(result.count[me], counts[me]);
        atomicMin(result.first[me], firsts[me]);
    }
    if (me == 0u) {
        atomicAdd(result.looked, looked);
        atomicAdd(result.elsewhere, elsewhere);
    }
}
