// SPDX-License-Identifier: MIT
// What a vertex shader knows of the thing being drawn, as instanced attributes: a software renderer fetches these several
// times faster than it reads a storage buffer.
#ifdef VERTEX_SHADER
#include "lib/posing.glsl"

layout(location = 0) in vec3 positionModel;
layout(location = 1) in vec3 normalModel;
layout(location = 2) in vec2 uvModel;
layout(location = 3) in vec4 worldFromModel[3];     // rows of an affine matrix
layout(location = 6) in vec4 drawBaseColour;        // linear, w = least alpha of a masked texel that exists
layout(location = 7) in vec4 drawEmissiveUnlit;     // xyz linear emission, w = 1: shows its colour unlit
layout(location = 8) in vec4 lastWorldFromModel[3]; // of the frame before
#ifdef VERTEX_COLOURS
layout(location = 11) in vec4 colourModel; // linear
#endif
layout(location = 13) in float drawObject;       // the number of the thing that it is part of, from 1
layout(location = 12) in vec3 lastPositionModel; // of the frame before, where a skin or morph targets move it

Affine affine(vec4 rows[3]) { return Affine(rows[0], rows[1], rows[2]); }
#endif
