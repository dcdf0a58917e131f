// SPDX-License-Identifier: MIT
// Lookups in a depth map, texel by texel, each compared with the depth that the receiver's own plane has at that texel's
// centre. On a plane the comparison is then exact at any slope and any kernel size, and the biases are left with rounding
// and curvature.
#include "resolve.glsl"

uniform sampler2D shadowMap;

// Axial depth [m] of the map depth z.
float axialDepth(float z) { return z / lightView.range.z + lightView.range.x; }

// What a lookup needs of a receiver, in texels and map depth.
struct Lookup {
    vec2 texel;     // the receiver's place on the map [texels]
    vec2 gradient;  // of the plane; see planeGradient(), per texel
    float compared; // the receiver's depth in the units of the comparison
    float offset;   // added to a stored depth before the comparison
    float farthest; // of the plane's change of depth: where it reaches the far end, or at the receiver itself
};

// `constantBias` in map depth, `slopeTexels` in texels of slope. With `withPlane` false every texel is compared with the
// receiver's own depth. `onlyNearer`: a texel must also be nearer to the light than the receiver itself, as everything
// between the two is; without it surfaces that a concave corner shares with the receiver count as blockers.
Lookup makeLookup(Receiver r, float constantBias, float slopeTexels, bool withPlane, bool onlyNearer)
{
    Lookup l;
    float size = lightView.light.z;
    vec2 metresPerTexel = 2.0 * lightView.window.zw * lightView.light.w;
    l.texel = ((r.reference - lightView.window.xy) / (2.0 * lightView.window.zw) + 0.5) * size;
    // Where the sample point of the light grazes or lies below the surface, its plane says nothing.
    bool lit = directional ? r.facing > 1e-4 : r.facing < -1e-4 * r.d;
    vec2 g = lit ? planeGradient(r.normalLight, r.facing, r.d, lightView.sample_reference.z, directional) : vec2(0.0);
    g *= metresPerTexel;
    float slope = abs(g.x) + abs(g.y);
    float perMetre = lightView.range.z;
    if (directional) {
        g *= perMetre;
        l.compared = (r.d - lightView.range.x) * perMetre;
        l.offset = constantBias + slopeTexels * slope * perMetre;
        l.farthest = onlyNearer ? 0.0 : 1.0 - l.compared;
    } else {
        l.compared = r.d * perMetre;
        l.offset = lightView.range.x * perMetre + constantBias + slopeTexels * slope * r.d * perMetre;
        l.farthest = onlyNearer ? 0.0 : r.d / lightView.range.y - 1.0;
    }
    l.gradient = withPlane ? g : vec2(0.0);
    return l;
}

// With its plane moved to where the receiver itself has the map depth z.
Lookup atDepth(Lookup l, float z)
{
    l.compared = z + l.offset;
    if (l.farthest != 0.0)
        l.farthest = directional ? 1.0 - l.compared : l.compared / (lightView.range.z * lightView.range.y) - 1.0;
    return l;
}

// Of a probe's columns: even over all depths of a kernel, from `nearest` to `farthest`, and a little beyond. The column
// next to the fragment has the fragment's own.
float depthOfColumn(int column, int columns, float nearest, float farthest, float z_f)
{
    float margin = 0.1 * (farthest - nearest) + 1e-3;
    float step = (farthest - nearest + 2.0 * margin) / float(columns - 1);
    float t = nearest - margin + float(column) * step;
    return abs(t - z_f) <= 0.5 * step ? z_f : t;
}

// Where one pixel is probed: at the depth of this column.
#ifdef AT_ALL_DEPTHS
Lookup atProbedDepth(Lookup l) { return atDepth(l, texelFetch(kernelDepths, texelHere().xy, 0).x); }
#else
Lookup atProbedDepth(Lookup l) { return l; }
#endif

// 1 if the caster stored as z at an offset of δ texels lies in front of the receiver's plane. An empty texel, z = 1, never
// does: the plane is cut off at the far end.
float blocks(Lookup l, float z, vec2 delta)
{
    float change = dot(l.gradient, delta);
    float stored = z + l.offset;
    if (directional) return stored < l.compared + min(change, l.farthest) ? 1.0 : 0.0;
    return stored * (1.0 + max(change, l.farthest)) < l.compared ? 1.0 : 0.0;
}

// The stored depth of the texel whose lower left corner is `corner` [texels]. The sampler clamps to the edge: outside the
// map its empty border answers.
float signedDepthIn(sampler2D map, vec2 corner) { return textureLod(map, (corner + 0.5) * lightView.light.w, 0.0).x; }
float signedDepth(vec2 corner) { return signedDepthIn(shadowMap, corner); }
float storedDepth(vec2 corner) { return abs(signedDepth(corner)); } // a sign only tags what has moved

// The stored depths of the four texels from `corner` on: w, z in its row, x, y in the row above.
vec4 gatheredDepths(vec2 corner) { return textureGather(shadowMap, (corner + 1.0) * lightView.light.w); }

// Of the texel that contains `place` [texels].
float blocksAt(Lookup l, vec2 place)
{
    vec2 corner = floor(place);
    return blocks(l, storedDepth(corner), corner + 0.5 - l.texel);
}

// Bilinear over the comparisons of the four texels around `place`, what a comparing sampler does.
float blocksBilinear(Lookup l, vec2 place)
{
    vec2 corner = floor(place - 0.5);
    vec2 f = place - 0.5 - corner;
    vec2 delta = corner + 0.5 - l.texel;
    vec4 z = gatheredDepths(corner);
    float b00 = blocks(l, z.w, delta);
    float b10 = blocks(l, z.z, delta + vec2(1, 0));
    float b01 = blocks(l, z.x, delta + vec2(0, 1));
    float b11 = blocks(l, z.y, delta + vec2(1, 1));
    return mix(mix(b00, b10, f.x), mix(b01, b11, f.x), f.y);
}
