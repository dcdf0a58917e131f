// SPDX-License-Identifier: MIT
// The arithmetic of fractional-disk soft shadows (Valient and de Boer, ShaderX4, 2006). A receiver is lit by the share of
// a disk around it, parallel to the light, that a point in the light's centre lights. The disk has the shape of the light.

// Equation 1: half size of the disk, with the light of half size r at d1 before the occluder and the receiver d2 behind
// it. Of a directional light r is the tangent of its angular radius and d1 = 1.
vec2 diskRadius(vec2 r, float d1, float d2)
{
    return r * (d2 / d1);
}

// Equation 2 for a disk of any shape: one sample for `texelsPerSample` (a) of its texels, at least one.
float sampleCount(float texels, float texelsPerSample)
{
    return max(-floor(-texels / texelsPerSample), 1.0f);
}

// Texels of a disk or rectangle of half size q [texels].
float diskTexels(vec2 q, bool round)
{
    return (round ? 3.14159265f : 4.0f) * q.x * q.y;
}

// The blue channel: 1 on a hard boundary before the first of n passes, one more for each pass that has reached a texel.
// So it is n + 1 − d at a distance of d texels, and 0 beyond n.
float inverseDistance(float d, float n)
{
    return d <= n ? n + 1.0f - d : 0.0f;
}

// What jump flooding keeps of a texel that knows of no edge yet: an offset beyond any that it finds.
const float floodUnknown = 1024.0f;

// Whether a hard boundary lies within `radius` texels, at most n, of a texel of that inverse distance.
bool nearBoundary(float inverse, float n, float radius)
{
    return inverse > 0.0f && n + 1.0f - inverse <= radius;
}

// The listing's test for the same, which goes the wrong way: it softens the less the wider the penumbra is.
bool nearBoundaryAsPrinted(float inverse, float radius)
{
    return inverse > 0.0f && radius <= inverse;
}

// The two-step test: an occluder at depth d1 hides light from the receiver d2 behind it only if the receiver lies on the
// disk that the occluder itself has there. `across` is the offset between the two on the receiver's plane, in units of
// which there are `scale` in a metre. Equation 1 without its division.
bool withinOwnDisk(vec2 across, vec2 r, float d1, float d2, float scale, bool round)
{
    vec2 a = vec2(abs(across.x), abs(across.y)) * d1;
    vec2 own = r * (d2 * scale);
    if (round) return dot(a, a) <= own.x * own.x;
    return a.x <= own.x && a.y <= own.y;
}

// Where a point belongs: figure 1a.
const int regionNone = 0;
const int regionLit = 1;
const int regionOuter = 2; // lit by the light's centre, and near a boundary
const int regionInner = 3;
const int regionUmbra = 4;

int regionOf(bool shadowed, bool nearby)
{
    return shadowed ? (nearby ? regionInner : regionUmbra) : (nearby ? regionOuter : regionLit);
}
