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
flat out vec4 emissive_unlit;
#ifdef VERTEX_COLOURS
out vec4 vertexColour;
#endif
#ifdef MOTION
out vec4 lastClip;
out vec4 clip;
#endif
void main()
{
    positionWorld = transformed(affine(worldFromModel), positionModel);
    normalWorld = transformedNormal(affine(worldFromModel), normalModel);
    gl_Position = view.clipFromWorld * vec4(positionWorld, 1.0);
#if defined(TEXTURED) || defined(MASKED)
    uv = uvModel;
#endif
    baseColour = drawBaseColour;
    emissive_unlit = drawEmissiveUnlit;
#ifdef VERTEX_COLOURS
    vertexColour = colourModel;
#endif
#ifdef MOTION
    clip = gl_Position;
    lastClip = lastClipFromWorld * vec4(transformed(affine(lastWorldFromModel), lastPositionModel), 1.0);
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
flat in vec4 emissive_unlit;
#ifdef VERTEX_COLOURS
in vec4 vertexColour;
#endif
#ifdef PEELED
uniform sampler2D nearer; // eye depth of the layer before this one, 0: no surface
#endif
layout(location = 0) out float depth;
layout(location = 1) out vec4 normal;
#ifdef COLOUR
layout(location = COLOUR) out vec4 colour;
#endif
#ifdef MOTION
in vec4 lastClip;
in vec4 clip;
layout(location = MOTION) out vec4 motion;
#endif
void main()
{
#ifdef PARALLEL
    float eyeDepth = mix(view.size.w, view.size.z, gl_FragCoord.z);
#else
    float eyeDepth = 1.0 / gl_FragCoord.w; // clip w is the eye depth
#endif
    vec3 base = baseColour.rgb;
#ifdef VERTEX_COLOURS
    base *= vertexColour.rgb;
#endif
#if defined(TEXTURED) || defined(MASKED)
    base *= texture(baseColourTexture, uv).rgb;
#endif
#ifdef MASKED
    // Coverage from the finest level: coarser ones average it away and thin out what is far.
    float alpha = textureLod(baseColourTexture, uv, 0.0).a;
#ifdef VERTEX_COLOURS
    alpha *= vertexColour.a;
#endif
    if (alpha < baseColour.w) discard;
#endif
    // Directions only: the octahedron needs no unit length.
#ifdef PARALLEL
    vec3 towardsEye = -view.rayCorner.xyz;
#else
    vec3 towardsEye = view.eyeWorld.xyz - positionWorld;
#endif
    vec3 geometric = cross(dFdx(positionWorld), dFdy(positionWorld));
    if (dot(abs(geometric), vec3(1.0)) == 0.0) geometric = towardsEye; // needle triangles have no derivative
    geometric *= dot(geometric, towardsEye) < 0.0 ? -1.0 : 1.0;
    vec3 shading = normalWorld * (dot(normalWorld, geometric) < 0.0 ? -1.0 : 1.0);
    if (dot(abs(shading), vec3(1.0)) == 0.0) shading = geometric;
    normal = vec4(octahedralFromDirection(geometric), octahedralFromDirection(shading));
    depth = eyeDepth;
#ifdef COLOUR
    vec3 shown = min(base + emissive_unlit.xyz, 1.0);
    vec3 glow = max(emissive_unlit.xyz, emissive_unlit.w * shown);
    float own = max(glow.r, max(glow.g, glow.b)) / max(max(shown.r, max(shown.g, shown.b)), 1e-6);
    colour = vec4(sqrt(shown), own); // in 8 bits as even to the eye as sRGB
#endif
#ifdef MOTION
    motion = vec4((lastClip.xy / lastClip.w - clip.xy / clip.w) * 0.5 * view.size.xy, lastClip.w - clip.w, 0.0);
#endif
#ifdef PEELED
    // Beyond rounding: the same surface must not come again, nor anything where there was none.
    float before = texelFetch(nearer, ivec2(gl_FragCoord.xy), 0).x;
    if (before == 0.0 || eyeDepth <= before + 1e-6 * view.size.w) discard;
#endif
}
#endif
