// SPDX-License-Identifier: MIT
// Depth as seen from a point of the light, linear (shared/view.glsl.h).
#include "shared/view.glsl.h"
#include "draws.glsl"

layout(std140, binding = 0) uniform Constants {
    LightViewBlock lightView;
#ifdef NEEDLESS
    uvec4 needless; // a bit for each of the first things: it is not drawn
#endif
};

#ifdef VERTEX_SHADER
#if defined(RADIAL)
out vec3 fromLight; // [m]
#elif defined(LINEAR_DEPTH) || defined(RADIAL_OF_VERTICES)
out float z; // where it is linear in the position, interpolation keeps it exact
#endif
#ifdef SIGN_MOVERS
flat out float side; // −1 for what has moved since the last frame
#endif
#ifdef OBJECTS
flat out float castingObject;
#endif
#ifdef MASKED
out vec2 uv;
flat out float leastAlpha;
#ifdef VERTEX_COLOURS
out float vertexAlpha;
#endif
#endif
void main()
{
    vec4 positionWorld = vec4(transformed(affine(worldFromModel), positionModel), 1.0);
#if defined(RADIAL) || defined(RADIAL_OF_VERTICES)
    vec3 fromPoint = (lightView.lightFromWorld * positionWorld).xyz - vec3(lightView.sample_reference.xy, 0.0);
#endif
#if defined(RADIAL)
    fromLight = fromPoint;
#elif defined(RADIAL_OF_VERTICES)
    z = (length(fromPoint) - lightView.range.x) * lightView.range.z;
#elif defined(LINEAR_DEPTH)
    vec4 lightZ = vec4(lightView.lightFromWorld[0].z, lightView.lightFromWorld[1].z, lightView.lightFromWorld[2].z, lightView.lightFromWorld[3].z);
    z = (-dot(lightZ, positionWorld) - lightView.range.x) * lightView.range.z;
#endif
    gl_Position = lightView.clipFromWorld * positionWorld;
#ifdef NEEDLESS
    uint thing = uint(drawObject) - 1u;
    if (thing < 32u * uint(needless.length()) && (needless[thing >> 5] >> (thing & 31u) & 1u) != 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#endif
#ifdef SIGN_MOVERS
    bool moved = lastPositionModel != positionModel;
    for (int row = 0; row < 3; ++row) moved = moved || lastWorldFromModel[row] != worldFromModel[row];
    side = moved ? -1.0 : 1.0;
#endif
#ifdef OBJECTS
    castingObject = drawObject;
#endif
#ifdef MASKED
    uv = uvModel;
    leastAlpha = drawBaseColour.w;
#ifdef VERTEX_COLOURS
    vertexAlpha = colourModel.w;
#endif
#endif
}
#endif

#ifdef FRAGMENT_SHADER
#ifdef PEELED
uniform sampler2D nearer; // the layer before this one
#endif
#ifdef COLOUR_DEPTH
layout(location = 0) out float depth;
#endif
#ifdef SIGN_MOVERS
flat in float side;
#endif
#ifdef OBJECTS
flat in float castingObject;
layout(location = OBJECTS) out float object;
#endif
#if defined(RADIAL)
in vec3 fromLight;
#elif defined(LINEAR_DEPTH) || defined(RADIAL_OF_VERTICES)
in float z;
#endif
#ifdef MASKED
in vec2 uv;
flat in float leastAlpha;
#ifdef VERTEX_COLOURS
in float vertexAlpha;
#endif
uniform sampler2D baseColourTexture;
#endif
void main()
{
#ifdef MASKED
    float alpha = textureLod(baseColourTexture, uv, 0.0).a;
#ifdef VERTEX_COLOURS
    alpha *= vertexAlpha;
#endif
    if (alpha < leastAlpha) discard;
#endif
    // Of perspective maps and radial metrics the rasteriser's own depth is not what is stored.
#if defined(RADIAL)
    float stored = clamp((length(fromLight) - lightView.range.x) * lightView.range.z, 0.0, 1.0);
#elif defined(LINEAR_DEPTH) || defined(RADIAL_OF_VERTICES)
    float stored = clamp(z, 0.0, 1.0);
#else
    float stored = gl_FragCoord.z;
#endif
#ifdef PEELED
    // Beyond rounding: the same surface must not come again.
    if (stored <= texelFetch(nearer, ivec2(gl_FragCoord.xy), 0).x + 1e-6) discard;
#endif
#if defined(RADIAL) || defined(LINEAR_DEPTH) || defined(RADIAL_OF_VERTICES)
    gl_FragDepth = stored;
#endif
#ifdef OBJECTS
    object = castingObject;
#endif
#ifdef SIGN_MOVERS
    depth = side * max(stored, 1e-6); // zero has no sign
#elif defined(COLOUR_DEPTH)
    depth = stored;
#endif
}
#endif
