// SPDX-License-Identifier: MIT
// An image's numbers as colours: range, colour map, marks. The nearest texel a pixel; transparent outside of the image.
#include "lib/srgb.glsl"
#include "lib/colour_map.glsl"
#include "inspect/source.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, binding = 0) uniform Constants { PaintBlock paint; };
uniform writeonly image2D painted;

vec3 markColour(uint marks)
{
    if ((marks & 1u) != 0u) return vec3(1.0, 0.0, 1.0);
    if ((marks & 2u) != 0u) return vec3(0.0, 1.0, 1.0);
    if ((marks & 8u) != 0u) return vec3(1.0, 0.45, 0.0);
    return vec3(0.25, 0.5, 1.0);
}

vec3 colourOf(vec3 v)
{
    float low = paint.range_map_marks.x, high = paint.range_map_marks.y;
    int map = int(paint.range_map_marks.z);
    if (map == 3) return flagColour(v.x);
    // Zero is the middle of a diverging map.
    if (map == 2) return diverging(clamp(v.x / max(abs(low), abs(high)), -1.0, 1.0));
    vec3 t = clamp(vec3(placeIn(v.x, low, high), placeIn(v.y, low, high), placeIn(v.z, low, high)), 0.0, 1.0);
    return map == 1 ? viridis(t.x) : t;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, paint.target.zw))) return;
    vec2 at = floor(paint.window.xy + (vec2(pixel) + 0.5) * paint.window.z);
    ivec2 texel = ivec2(at), size = paint.source.place.zw;
    vec4 result = vec4(0.0);
    if (all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(size)))) {
        vec3 v = shown(sourceTexel(paint.source.place, texel), paint.source.channels);
        uint marks = marksOf(v, paint.source) & uint(paint.range_map_marks.w);
        result = vec4(marks != 0u ? markColour(marks) : colourOf(v), 1.0);
    }
    imageStore(painted, paint.target.xy + pixel, result);
}
