// SPDX-License-Identifier: MIT
// What a vertex or fragment shader knows of the thing being drawn. One entry per drawable, picked by the instanced
// attribute drawIndex.
struct DrawData {
    mat4 worldFromModel;
    mat4 lastWorldFromModel; // of the frame before
    vec4 baseColour;         // linear
    vec4 emissive_cutoff;    // xyz linear emission, w = alpha cutoff of masked materials
};
layout(std430, binding = 0) readonly buffer Draws { DrawData draws[]; };

#ifdef VERTEX_SHADER
layout(location = 0) in vec3 positionModel;
layout(location = 1) in vec3 normalModel;
layout(location = 2) in vec2 uvModel;
layout(location = 3) in uint drawIndex;
#endif
