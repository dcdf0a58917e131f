// SPDX-License-Identifier: MIT
// What both sides know of a view and of a shadow map's projection. Compiled by C++ (renderer/shared.h) and by GLSL;
// rows of 16 bytes only, so that std140 and C++ agree.

// A picture's rays: positionWorld = eyeWorld + x·eyeDx + y·eyeDy + depth · (rayCorner + x·rayDx + y·rayDy), (x, y) in
// pixels from the lower left corner, centres at ½, depth along the view axis [m].
struct ViewBlock {
    mat4 clipFromWorld;
    vec4 eyeWorld;
    vec4 rayCorner;
    vec4 rayDx; // w, and that of rayDy: pixels between the edges of the geometry buffer and of the image that is written
    vec4 rayDy;
    vec4 eyeDx, eyeDy; // 0 for a camera, else rayDx and rayDy are
    vec4 size;         // width, height [pixels], near, far [m]
};

// A shadow map as seen from a point of the light.
//
// Light space: origin in the light's centre, the light looks down −Z; d = −z is the axial depth. Maps are laid out on
// the reference plane d = f. A point P seen from the light's point s falls on the reference plane at
//     p = s + (P.xy − s) f / d          area light, s [m] on the light
//     p = P.xy + s (d − f)              directional light, s = tangent of the sample's direction
// so that what lies on the reference plane is at the same texel for every s. uv = (p − centre) / (2 halfSize) + ½.
// Stored depth: z = (d − near) / (far − near), or with d the distance from s where the metric is radial.
struct LightViewBlock {
    mat4 clipFromWorld;  // for the rasteriser; x, y are those of the map, z is only for clipping
    mat4 lightFromWorld;
    vec4 sample_reference; // xy = s, z = f [m], w = 1 for a directional light, else 0
    vec4 window;           // xy centre, zw half size, on the reference plane [m]
    vec4 range;            // x = near, y = far [m], z = 1 / (far − near) [1/m], w = 1 if the metric is radial
    vec4 light;            // xy half size of the light [m, or tangent], z = texels along a side, w = 1 / z
};
