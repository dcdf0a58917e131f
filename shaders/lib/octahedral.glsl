// SPDX-License-Identifier: MIT
// Directions on the octahedron, unfolded to [−1, 1]² (Meyer et al. 2010): two numbers, evenly precise.

// v of any length but zero.
vec2 octahedralFromDirection(vec3 v)
{
    float scale = 1.0f / (abs(v.x) + abs(v.y) + abs(v.z));
    vec2 p = vec2(v.x * scale, v.y * scale);
    if (v.z < 0.0f)
        p = vec2((1.0f - abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
    return p;
}

vec3 unitFromOctahedral(vec2 p)
{
    float z = 1.0f - abs(p.x) - abs(p.y);
    float fold = max(-z, 0.0f);
    return normalize(vec3(p.x + (p.x >= 0.0f ? -fold : fold), p.y + (p.y >= 0.0f ? -fold : fold), z));
}
