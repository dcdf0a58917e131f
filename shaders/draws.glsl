// SPDX-License-Identifier: MIT
// What a vertex shader knows of the thing being drawn, as instanced attributes: a software renderer fetches these several
// times faster than it reads a storage buffer.
#ifdef VERTEX_SHADER
layout(location = 0) in vec3 positionModel;
layout(location = 1) in vec3 normalModel;
layout(location = 2) in vec2 uvModel;
layout(location = 3) in vec4 worldFromModel[3];     // rows of an affine matrix
layout(location = 6) in vec4 drawBaseColour;        // linear
layout(location = 7) in vec4 drawEmissiveCutoff;    // xyz linear emission, w = alpha cutoff of masked materials
layout(location = 8) in vec4 lastWorldFromModel[3]; // of the frame before

vec3 transformed(vec4 rows[3], vec3 position)
{
    vec4 p = vec4(position, 1.0);
    return vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
}

// By the cofactors: normals stay normal under uneven and mirrored scale.
vec3 transformedNormal(vec4 rows[3], vec3 n)
{
    return vec3(dot(cross(rows[1].xyz, rows[2].xyz), n), dot(cross(rows[2].xyz, rows[0].xyz), n),
                dot(cross(rows[0].xyz, rows[1].xyz), n));
}
#endif
