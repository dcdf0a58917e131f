// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows without single comparisons: what blocks within a window is told by the moments of all its
// depths, from a summed-area table. First over the region through which the receiver sees the light past the nearest caster:
// the mean depth of what blocks. Then over the penumbra of such a blocker.
//
// A window is divided into cells, each with moments of its own that are held against the receiver's plane at its middle. Bounds
// of parts are never lower than that of the whole, and the plane rises less within them. With ever more cells this becomes
// percentage-closer filtering of every texel.
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
vec4 sumOf(Columns above, Columns below, vec2 share)
{
    return vec4(above.between - below.between) + share.y * vec4(above.right - below.right) -
           share.x * vec4(above.left - below.left);
}

// The moments over a box [texels], whose edges may cut texels. Outside the map nothing casts.
vec4 momentsIn(vec2 low, vec2 high)
{
    vec2 size = vec2(lightView.light.z);
    vec2 from = clamp(low, vec2(0.0), size);
    vec2 to = clamp(high, vec2(0.0), size);
    ivec2 a = ivec2(from);
    ivec2 b = ivec2(to);
    vec2 cutA = from - vec2(a);
    vec2 cutB = to - vec2(b);
    vec2 x = vec2(cutA.x, cutB.x);
    Columns y0 = columnsBelow(a.x, b.x, a.y), y1 = columnsBelow(a.x, b.x, a.y + 1);
    Columns y2 = columnsBelow(a.x, b.x, b.y), y3 = columnsBelow(a.x, b.x, b.y + 1);
    vec4 sum = sumOf(y2, y0, x) + cutB.y * sumOf(y3, y2, x) - cutA.y * sumOf(y1, y0, x);
    vec2 within = to - from;
    float texels = max(within.x * within.y, 1e-6);
    float share = within.x * within.y / ((high.x - low.x) * (high.y - low.y));
    return mix(lookup.empty, lookup.momentsFromSum * (sum / texels) + lookup.momentsOffset, share);
}

// The receiver's plane at an offset of δ texels, in map depth; in front of it a stored depth blocks (blocks() of
// shadow_lookup.glsl).
float planeDepthAt(Lookup l, vec2 delta)
{
    float change = dot(l.gradient, delta);
    return (directional ? l.compared + min(change, l.farthest) : l.compared / (1.0 + max(change, l.farthest))) - l.offset;
}

// Of a window around the receiver's place, n by n cells.
InFront inFrontWithin(Lookup l, vec2 halfSize, int n)
{
    vec2 cell = 2.0 * halfSize / float(max(n, 1));
    // A plane's depths within a cell, as a standard deviation.
    float deviation = length(l.gradient * cell) * 0.28867513 * (directional ? 1.0 : l.compared);
    InFront sum = InFront(0.0, 0.0);
    for (int i = 0; i < n * n; ++i) {
        vec2 delta = (vec2(i % n, i / n) + 0.5) * cell - halfSize;
        float z = planeDepthAt(l, delta) - planeBias * deviation;
        vec2 middle = l.texel + delta;
        InFront f = blockingIn(momentsIn(middle - 0.5 * cell, middle + 0.5 * cell),
                              fma(z, lookup.depth.x, lookup.depth.y));
        sum.psi += f.psi;
        sum.moment += f.moment;
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

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, true, true);
    bool sane = abs(l.compared) < 1e30 && all(lessThan(abs(l.texel), vec2(1e6)));
    int searched = r.known < 0.0 && sane ? cells : 0;
    InFront found = inFrontWithin(l, windowOf(r, lightView.range.x), searched);
    float z_b = (found.moment / max(found.psi, leastFound) - lookup.depth.y) / lookup.depth.x;
    int filtered = found.psi > leastFound ? cells : 0;
    float d_b = clamp(axialDepth(z_b), lightView.range.x, lightView.range.y);
    float psi = inFrontWithin(l, windowOf(r, d_b), filtered).psi;
    writeShadow(r, clamp(psi, 0.0, 1.0));
}
