// SPDX-License-Identifier: MIT
// What both sides know of a moment map. Compiled by C++ (renderer/shadow_map/moment_map.h) and by GLSL; rows of 16 bytes.

const int mostKernel = 63; // texels
const int probeColumns = 256;

// A pass that filters along rows or columns.
struct MomentFilterBlock {
    mat4 storedFromMoments; // on the first pass; what is stored is this times the moments, plus `storedOffset`
    vec4 storedOffset;
    vec4 depth_exponents; // xy: the functions are of x z + y, z in [0, 1]; zw = exponents
    ivec4 kernel;         // x = texels on either side of the centre
    vec4 weights[36];     // x: of the centre, of those beside it ..., 0 beyond; one a vector, since a component by number is slow
};

// How stored moments, filtered, are read: moments = momentsFromStored · stored + momentsOffset, the moment bias included.
struct MomentLookupBlock {
    mat4 momentsFromStored;
    vec4 momentsOffset;
    vec4 depth_exponents; // as in MomentFilterBlock
    vec4 range;           // DepthRange of lib/moments.glsl
    vec4 border_perTexel; // x: texels by which the map begins before the shadow map, y: 1 / texels along a side
    ivec4 probed;         // xy: the pixel that is looked at closely, z: texels on either side of the kernel's centre
    vec4 weights[8];      // of the kernel's centre, of those beside it ..., four a vector
};
