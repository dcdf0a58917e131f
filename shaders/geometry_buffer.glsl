// SPDX-License-Identifier: MIT
// The surfaces that receive shadows: eye depth, normals, and on request base colour and motion.
#include "shared/view.glsl.h"
#include "lib/octahedral.glsl"
#include "draws.glsl"

layout(std140, binding = 0) uniform Constants {
    ViewBlock view;
    mat4 lastClipFromWorld;
};

#ifdef VERTEX_SHADER
out vec3 positionWorld;
out vec3 normalWorld;
#if defined(TEXTURED) || defined(MASKED)
out vec2 uv;
#endif
flat out vec4 baseColour;
flat out vec4 emissive_cutoff;
#ifdef MOTION
out vec4 lastClip;
out vec4 clip;
#endif
void main()
{
    positionWorld = transformed(worldFromModel, positionModel);
    normalWorld = transformedNormal(worldFromModel, normalModel);
    gl_Position = view.clipFromWorld * vec4(positionWorld, 1.0);
#if defined(TEXTURED) || defined(MASKED)
    uv = uvModel;
#endif
    baseColour = drawBaseColour;
    emissive_cutoff = drawEmissiveCutoff;
#ifdef MOTION
    clip = gl_Position;
    lastClip = lastClipFromWorld * vec4(transformed(lastWorldFromModel, positionModel), 1.0);
#endif
}
#endif

#ifdef FRAGMENT_SHADER
in vec3 positionWorld;
in vec3 normalWorld;
#if defined(TEXTURED) || defined(MASKED)
in vec2 uv;
uniform sampler2D baseColourTexture;
#endif
flat in vec4 baseColour;
flat in vec4 emissive_cutoff;
layout(location = 0) out float depth;
layout(location = 1) out vec4 normal;
#ifdef COLOUR
layout(location = COLOUR) out vec4 colour;
#endif
#ifdef MOTION
in vec4 lastClip;
in vec4 clip;
layout(location = MOTION) out vec2 motion;
#endif
void main()
{
    vec4 base = baseColour;
#if defined(TEXTURED) || defined(MASKED)
    base *= texture(baseColourTexture, uv);
#endif
#ifdef MASKED
    // Coverage from the finest level: coarser ones average it away and thin out what is far.
    if (textureLod(baseColourTexture, uv, 0.0).a * baseColour.a < emissive_cutoff.w) discard;
#endif
    // Directions only: the octahedron needs no unit length.
    vec3 towardsEye = view.eyeWorld.xyz - positionWorld;
    vec3 geometric = cross(dFdx(positionWorld), dFdy(positionWorld));
    if (dot(abs(geometric), vec3(1.0)) == 0.0) geometric = towardsEye; // needle triangles have no derivative
    geometric *= dot(geometric, towardsEye) < 0.0 ? -1.0 : 1.0;
    vec3 shading = normalWorld * (dot(normalWorld, geometric) < 0.0 ? -1.0 : 1.0);
    if (dot(abs(shading), vec3(1.0)) == 0.0) shading = geometric;
    normal = vec4(octahedralFromDirection(geometric), octahedralFromDirection(shading));
    depth = 1.0 / gl_FragCoord.w; // clip w is the eye depth
#ifdef COLOUR
    colour = vec4(sqrt(min(base.rgb + emissive_cutoff.xyz, 1.0)), 1.0); // in 8 bits as even to the eye as sRGB
#endif
#ifdef MOTION
    motion = (lastClip.xy / lastClip.w - clip.xy / clip.w) * 0.5 * view.size.xy;
#endif
}
#endif
