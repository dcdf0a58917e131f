// SPDX-License-Identifier: MIT
// Receiver, blocker and light on a shadow map's reference plane (shared/view.glsl.h). Lengths in metres, depths axial.

// Where the light-space point P falls on the reference plane d = f, seen from the light's point s.
vec2 referenceFromLight(vec3 positionLight, vec2 s, float f, bool directional)
{
    float d = -positionLight.z;
    vec2 xy = vec2(positionLight.x, positionLight.y);
    return directional ? xy + s * (d - f) : s + (xy - s) * (f / d);
}

// How that place moves with P.
vec2 referenceStep(vec3 positionLight, vec3 step, vec2 s, float f, bool directional)
{
    float d = -positionLight.z;
    vec2 across = vec2(step.x, step.y);
    vec2 xy = vec2(positionLight.x, positionLight.y);
    return directional ? across - s * step.z : (across + (xy - s) * (step.z / d)) * (f / d);
}

// From where a pixel's ray, eye + depth · ray, meets a plane of normal n to where the next pixel's does. Where the view grazes
// the plane a step is cut to the depth's.
vec3 stepAlongPlane(vec3 eyeStep, vec3 rayStep, float depth, vec3 ray, vec3 n)
{
    vec3 across = eyeStep + depth * rayStep;
    float facing = dot(n, ray);
    float along = abs(facing) > 1e-6f ? clamp(-dot(n, across) / facing, -depth, depth) : 0.0f;
    return across + along * ray;
}

// Half size, on the reference plane, of the region through which a receiver at depth d_r sees the light of half size r
// when the blockers lie at depth d_b. With d_b the mean blocker depth this is the penumbra's (Fernando 2005, Scherzer
// 2009 eq. 6: w = r (d_r − d_b) / d_b on the receiver, times f / d_r); with d_b the nearest depth in the map it is the
// search region. Exact where light, blocker and receiver are parallel.
//     area:         r f (1/d_b − 1/d_r)
//     directional:  tan(angular radius) (d_r − d_b)
// d_b > 0; returns 0 when d_b >= d_r.
vec2 penumbraHalfSize(vec2 r, float d_r, float d_b, float f, bool directional)
{
    float gap = max(d_r - d_b, 0.0f);
    return directional ? r * gap : r * (f * gap / (d_b * d_r));
}

// How fast the receiver's own plane falls away on the reference plane, exactly (algorithms of receiver-plane bias use a
// linear estimate; this is the plane itself). At offset δ from the receiver's place on the reference plane the plane
// through the receiver with unit normal n lies at depth
//     d = d_r / (1 + g·δ)   area light:          g = n.xy d_r / (f n·(P − S))      [1/m]
//     d = d_r + g·δ         directional light:   g = n.xy / (n·l), l = (s, 1)      [1]
// facing = n·(P − S) [m] of an area light (negative on the lit side), or n·l of a directional one (positive).
vec2 planeGradient(vec3 normalLight, float facing, float d_r, float f, bool directional)
{
    vec2 n = vec2(normalLight.x, normalLight.y);
    return directional ? n / facing : n * (d_r / (f * facing));
}

// The depth of that plane at δ; `farthest` where the ray through δ never meets it.
float planeDepth(vec2 g, vec2 delta, float d_r, float farthest, bool directional)
{
    float change = g.x * delta.x + g.y * delta.y;
    if (directional) return min(d_r + change, farthest);
    float w = 1.0f + change;
    return w > d_r / farthest ? d_r / w : farthest;
}
