// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows without single comparisons: what blocks within a window is told by the moments of all its
// depths, from a summed-area table. First over the region through which the receiver sees the light past the nearest caster:
// the mean depth of what blocks. Then over the penumbra of such a blocker.
//
// A window is divided into cells, each with moments of its own that are held against the receiver's plane at its middle. Bounds
// of parts are never lower than that of the whole, and the plane rises less within them. With ever more cells this becomes
// percentage-closer filtering of every texel.
#include "shared/moments.glsl.h"
#include "shared/summed_area.glsl.h"
#define OWN_CONSTANTS SummedAreaLookupBlock lookup;
#include "shadow_lookup.glsl"
#include "lib/moments.glsl"

uniform usampler2D sums;

// What a technique makes of the moments of a cell.
InFront blockingIn(vec4 b, float z_f);

DepthRange mappedRange() { return DepthRange(lookup.range.x, lookup.range.y, lookup.range.z, lookup.range.w); }

// Over all texels left of and below an edge.
uvec4 sumBefore(ivec2 edge)
{
    uvec4 sum = texelFetch(sums, max(edge - 1, 0), 0);
    return all(greaterThan(edge, ivec2(0))) ? sum : uvec4(0u);
}

// Over texels below the edge y: from the column of one edge to that of the other, and of either edge's column alone.
struct Columns {
    uvec4 between, left, right;
};
Columns columnsBelow(int left, int right, int y)
{
    uvec4 a = sumBefore(ivec2(left, y));
    uvec4 b = sumBefore(ivec2(right, y));
    return Columns(b - a, sumBefore(ivec2(left + 1, y)) - a, sumBefore(ivec2(right + 1, y)) - b);
}

// Differences of whole numbers are exact; only then are they weighed by the share of a column that lies within.
vec4 sumOf(Columns above, Columns under, vec2 share)
{
    return vec4(above.between - under.between) + share.y * vec4(above.right - under.right) -
           share.x * vec4(above.left - under.left);
}

// All between two columns of edges and below an edge that cuts a row of texels.
struct Below {
    Columns rows;
    vec4 part; // of the row that is cut
};
Below below(vec2 x, float y)
{
    ivec3 edge = ivec3(x, y);
    vec2 share = x - vec2(edge.xy);
    Columns rows = columnsBelow(edge.x, edge.y, edge.z);
    return Below(rows, (y - float(edge.z)) * sumOf(columnsBelow(edge.x, edge.y, edge.z + 1), rows, share));
}

// The moments over a box, whose edges may cut texels, from what lies below its two ends; outside the map nothing casts. `area`
// is the box's, and what lies within the map may be less [texels].
vec4 momentsBetween(Below top, Below bottom, vec2 x, float height, float area)
{
    vec4 sum = sumOf(top.rows, bottom.rows, x - floor(x)) + top.part - bottom.part;
    float within = (x.y - x.x) * height;
    vec4 moments = lookup.momentsFromSum * (sum / max(within, 1e-6)) + lookup.momentsOffset;
    return mix(lookup.empty, moments, within / area);
}

// The receiver's plane at an offset of δ texels, in map depth; in front of it a stored depth blocks (blocks() of
// shadow_lookup.glsl).
float planeDepthAt(Lookup l, vec2 delta)
{
    float change = dot(l.gradient, delta);
    return (directional ? l.compared + min(change, l.farthest) : l.compared / (1.0 + max(change, l.farthest))) - l.offset;
}

// Of a window around the receiver's place, n by n cells, column by column: 8 (n + 1) n texture reads.
InFront inFrontWithin(Lookup l, vec2 halfSize, int n)
{
    vec2 cell = 2.0 * halfSize / float(max(n, 1));
    float size = lightView.light.z;
    // A plane's depths within a cell, as a standard deviation.
    float deviation = length(l.gradient * cell) * 0.28867513 * (directional ? 1.0 : l.compared);
    InFront sum = InFront(0.0, 0.0);
    for (int i = 0; i < n; ++i) {
        vec2 x = clamp(l.texel.x - halfSize.x + vec2(i, i + 1) * cell.x, 0.0, size);
        float y = clamp(l.texel.y - halfSize.y, 0.0, size);
        Below bottom = below(x, y);
        for (int j = 0; j < n; ++j) {
            float upper = clamp(l.texel.y - halfSize.y + float(j + 1) * cell.y, 0.0, size);
            Below top = below(x, upper);
            float z = planeDepthAt(l, (vec2(i, j) + 0.5) * cell - halfSize) - planeBias * deviation;
            InFront f = blockingIn(momentsBetween(top, bottom, x, upper - y, cell.x * cell.y),
                                   fma(z, lookup.depth.x, lookup.depth.y));
            sum.psi += f.psi;
            sum.moment += f.moment;
            bottom = top;
            y = upper;
        }
    }
    float share = 1.0 / float(max(n * n, 1));
    return InFront(sum.psi * share, sum.moment * share);
}

// Where less is found in front, nothing is: what moment bias and rounding leave.
const float leastFound = 1e-3;
// Never narrower than the texel itself: smaller windows only show its staircase.
const vec2 smallestWindow = vec2(1.0);
// The half size of a square whose points are as far spread as those of a disk of radius 1.
const float squareOfDisk = 0.8660254;

// Half size [texels] of the region that hides the light where what blocks is at the axial depth d_b.
vec2 windowOf(Receiver r, float d_b)
{
    vec2 light = lightScale * lightView.light.xy * (roundLight ? squareOfDisk : 1.0);
    vec2 metres = penumbraHalfSize(light, r.d, d_b, lightView.sample_reference.z, directional);
    vec2 texels = metres * (lightView.light.z / (2.0 * lightView.window.zw));
    return clamp(texels, smallestWindow, vec2(lookup.depth.z));
}

// What hides the light: whether anything does, and the half size [texels] of the window that it is filtered over.
struct Penumbra {
    bool found;
    vec2 halfSize;
};
Penumbra findPenumbra(Receiver r, Lookup l)
{
    bool sane = abs(l.compared) < 1e30 && all(lessThan(abs(l.texel), vec2(1e6)));
    int searched = r.known < 0.0 && sane ? cells : 0;
    InFront blockers = inFrontWithin(l, windowOf(r, lightView.range.x), searched);
    float z_b = (blockers.moment / max(blockers.psi, leastFound) - lookup.depth.y) / lookup.depth.x;
    float d_b = clamp(axialDepth(z_b), lightView.range.x, lightView.range.y);
    Penumbra p;
    p.found = blockers.psi > leastFound;
    p.halfSize = windowOf(r, p.found ? d_b : lightView.range.x);
    return p;
}

#ifdef PROBED_WINDOW
uniform writeonly image2D kernelDepths;

// What a stored depth is where the receiver's plane is taken for level: it blocks at the same depths of the receiver.
float levelled(Lookup l, float z, vec2 delta)
{
    float change = dot(l.gradient, delta);
    return directional ? z - min(change, l.farthest) : (z + l.offset) * (1.0 + max(change, l.farthest)) - l.offset;
}

// Of a pixel's filter, at the depth of each column: the share of the window in front of it, and ψ there.
void main()
{
    ivec2 column = texelHere().xy;
    Receiver r = findReceiverOf(lookup.probed.xy, normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, true, true);
    Penumbra p = findPenumbra(r, l);
    float z_f = l.compared - l.offset;
    const int side = 64; // places across the window, so many that every texel of most windows is met
    float nearest = z_f;
    float farthest = z_f;
    for (int i = 0; i < side * side; ++i) {
        vec2 delta = (2.0 * (vec2(i % side, i / side) + 0.5) / float(side) - 1.0) * p.halfSize;
        float z = levelled(l, storedDepth(floor(l.texel + delta)), delta);
        nearest = min(nearest, z);
        farthest = max(farthest, z);
    }
    float t = depthOfColumn(column.x, probeColumns, nearest, farthest, z_f);
    float inFront = 0.0;
    for (int i = 0; i < side * side; ++i) {
        vec2 delta = (2.0 * (vec2(i % side, i / side) + 0.5) / float(side) - 1.0) * p.halfSize;
        inFront += levelled(l, storedDepth(floor(l.texel + delta)), delta) < t ? 1.0 : 0.0;
    }
    float psi = inFrontWithin(atDepth(l, t), p.halfSize, cells).psi;
    imageStore(kernelDepths, column, vec4(t, inFront / float(side * side), z_f, clamp(psi, 0.0, 1.0)));
}
#else
void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, true, true);
    Penumbra p = findPenumbra(r, l);
    writeShadow(r, clamp(inFrontWithin(l, p.halfSize, p.found ? cells : 0).psi, 0.0, 1.0));
}
#endif
