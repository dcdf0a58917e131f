// SPDX-License-Identifier: MIT
// What both sides know of a summed-area table of moments. Compiled by C++ (renderer/shadow_map/summed_area.h) and by GLSL;
// rows of 16 bytes.

const int runLength = 32; // texels that an invocation sums up

// How a texel becomes whole numbers: what is stored, matrix · powers + offset in [0, 1], times `levels`.
struct SummedAreaBlock {
    mat4 storedFromMoments;
    vec4 storedOffset;
    vec4 depth_levels; // xy: the powers are of x z + y, z in [0, 1]; z = levels
};

// How sums over a box are read: moments = momentsFromSum · (sum / texels) + momentsOffset, the moment bias included.
struct SummedAreaLookupBlock {
    mat4 momentsFromSum;
    vec4 momentsOffset;
    vec4 empty; // the moments where nothing casts, the bias included
    vec4 depth; // xy: as above; z = half size of the widest window [texels]
    vec4 range; // DepthRange of lib/moments.glsl
    ivec4 probed; // xy: the pixel that is looked at closely
};
