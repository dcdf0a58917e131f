// SPDX-License-Identifier: MIT
// Which thing each pixel shows, by number.
#include "shared/view.glsl.h"
#include "draws.glsl"

layout(std140, binding = 0) uniform Constants { ViewBlock view; };

#ifdef VERTEX_SHADER
flat out float seenObject;
#ifdef MASKED
out vec2 uv;
flat out float leastAlpha;
#ifdef VERTEX_COLOURS
out float vertexAlpha;
#endif
#endif
void main()
{
    gl_Position = view.clipFromWorld * vec4(transformed(affine(worldFromModel), positionModel), 1.0);
    seenObject = drawObject;
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
flat in float seenObject;
#ifdef MASKED
in vec2 uv;
flat in float leastAlpha;
#ifdef VERTEX_COLOURS
in float vertexAlpha;
#endif
uniform sampler2D baseColourTexture;
#endif
layout(location = 0) out float object;
void main()
{
#ifdef MASKED
    float alpha = textureLod(baseColourTexture, uv, 0.0).a;
#ifdef VERTEX_COLOURS
    alpha *= vertexAlpha;
#endif
    if (alpha < leastAlpha) discard;
#endif
    object = seenObject;
}
#endif
