// SPDX-License-Identifier: MIT
// The lit share of a disk around each receiver; see renderer/techniques/fractional_disk.cpp.
//
// Texture reads: depth, normal, 1 of the map; where it filters, a sample costs 1 of the map and, but for constants, 1 of
// the noise map; without pre-processing lit pixels search with as many samples first.
#define OWN_CONSTANTS vec4 shift_turn; // xy = texels by which the noise map is shifted; zw = see turned()
#ifdef ACCUMULATES
#define KEEPS_SAMPLES
#endif
#include "shadow_lookup.glsl"
#include "lib/fractional_disk.glsl"
#include "lib/sampling.glsl"

#if PREPARED
uniform sampler2D prepared; // depth, depth of the nearest occluder, inverse distance to the hard boundary
#endif
#if NOISE != NOISE_CONSTANTS
uniform sampler2D noise; // rows of points in the disk of the light's shape, from [−1, 1] to [0, 1]; two random numbers
#endif
#if OBJECT_IDS
uniform sampler2D casting;   // the number of the thing in each texel of the map
uniform sampler2D receiving; // and in each of the geometry buffer
#endif
#ifdef KEEPS_SAMPLES
uniform writeonly image2D samples; // hidden ones, all, eye depth [m], depth of the occluder [m]
#endif
#ifdef ACCUMULATES
uniform sampler2D history; // the same of the frames before
#endif
uniform writeonly image2D regions;

const bool slipNoise = LISTING == LISTING_NOISE || LISTING == LISTING_AS_PRINTED;
const bool slipEarlyOut = LISTING == LISTING_EARLY_OUT || LISTING == LISTING_AS_PRINTED;
const bool slipSum = LISTING == LISTING_SUM || LISTING == LISTING_AS_PRINTED;

// Accumulated frames turn the points of a round light by zw = (cos, sin) and shift those of a rectangle on the torus.
vec2 turned(vec2 p)
{
#ifndef ACCUMULATES
    return p;
#elif ROUND
    return vec2(shift_turn.z * p.x - shift_turn.w * p.y, shift_turn.w * p.x + shift_turn.z * p.y);
#else
    return 2.0 * fract(0.5 * p + shift_turn.zw) - 1.0;
#endif
}

// A point of the light's shape in [−1, 1]², the i-th of a pixel.
vec2 samplePoint(ivec2 start, int i)
{
#if NOISE == NOISE_CONSTANTS
    // The set once more, each time turned by another quarter.
    vec4 pair = table[(i & 63) >> 1];
    vec2 p = (i & 1) == 0 ? pair.xy : pair.zw;
    p = (i & 64) == 0 ? p : vec2(-p.y, p.x);
    p = (i & 128) == 0 ? p : -p;
#else
    ivec2 size = textureSize(noise, 0);
    ivec2 texel = ivec2((start.x + i) & (size.x - 1), (start.y + i / size.x) & (size.y - 1));
    vec2 p = 2.0 * texelFetch(noise, texel, 0).xy - 1.0;
#endif
    p = turned(p);
    return slipNoise ? 0.5 * p + 0.5 : p;
}

ivec2 firstSample(ivec2 pixel)
{
    ivec2 shifted = pixel + ivec2(shift_turn.xy);
#if NOISE == NOISE_CONSTANTS
    return ivec2(0);
#elif NOISE == NOISE_ONE_DIMENSIONAL
    return ivec2(int(float(textureSize(noise, 0).x) * gradientNoise(vec2(shifted))), 0);
#else
    ivec2 size = textureSize(noise, 0);
    ivec2 here = shifted & (size - 1);
#if NOISE == NOISE_INTERPOLATED
    return here;
#else
    return ivec2(texelFetch(noise, here, 0).zw * vec2(size));
#endif
#endif
}

// How a receiver looks at the map: all on the plane of constant axial depth through it.
struct Disk {
    float depth;         // axial, of the receiver [m]
    float bias;          // [m]
    float texelsPerMetre;
    vec2 halfLight;      // r [m, or tangent]
    vec2 fromSample;     // the receiver's place on the reference plane, from the light's point, over its depth
    float slopePerTexel; // what that grows by from texel to texel
    float object;        // its number
    bool twoStep;        // whether samples pass the two-step test
};

Disk makeDisk(Receiver r, Lookup l)
{
    float f = lightView.sample_reference.z;
    float texelsOfReference = lightView.light.z / (2.0 * lightView.window.z);
    Disk disk;
    disk.depth = r.d;
    disk.bias = l.offset * (lightView.range.y - lightView.range.x) - (directional ? 0.0 : lightView.range.x);
    disk.texelsPerMetre = texelsOfReference * (directional ? 1.0 : f / r.d);
    disk.halfLight = lightScale * lightView.light.xy;
    disk.fromSample = (r.reference - lightView.sample_reference.xy) / f;
    disk.twoStep = true;
    disk.slopePerTexel = 1.0 / (texelsOfReference * f);
#if OBJECT_IDS
    disk.object = texelFetch(receiving, surfaceTexel(r.pixel), 0).x;
#else
    disk.object = 0.0;
#endif
    return disk;
}

// Axial depth [m] of the map depth z, `offset` texels beside the receiver.
float occluderDepth(Disk disk, float z, vec2 offset)
{
    float d = z * (lightView.range.y - lightView.range.x) + lightView.range.x;
#ifdef RADIAL_METRIC
    vec2 t = disk.fromSample + offset * disk.slopePerTexel;
    d *= inversesqrt(1.0 + dot(t, t));
#endif
    return directional ? d : max(d, 1e-6);
}

float distanceToLight(float occluder) { return directional ? 1.0 : occluder; }

// Half size of the disk for an occluder at that axial depth [texels]; no longer than `most`.
vec2 diskTexelsHalf(Disk disk, float occluder, float most)
{
    vec2 q = diskRadius(disk.halfLight, distanceToLight(occluder), max(disk.depth - occluder, 0.0)) * disk.texelsPerMetre;
    float longest = max(q.x, q.y);
    return longest > most ? q * (most / longest) : q;
}

// Whether the texel may hide the receiver: not if it is of the same thing, where things are told apart.
bool ofAnother(Disk disk, vec2 corner)
{
#if OBJECT_IDS
    return textureLod(casting, (corner + 0.5) * lightView.light.w, 0.0).x != disk.object;
#else
    return true;
#endif
}

// The axial depth of what hides the receiver's disk from the light `offset` texels beside it; at least the receiver's
// own: nothing does.
float occluderAt(Disk disk, vec2 texel, vec2 offset)
{
    vec2 corner = floor(texel + offset);
    float z = storedDepth(corner);
    float d = occluderDepth(disk, z, corner + 0.5 - texel);
    bool occludes = z < 1.0 && d + disk.bias < disk.depth && ofAnother(disk, corner);
#if TWO_STEP != TWO_STEP_OFF
    bool holds = withinOwnDisk(offset, disk.halfLight, distanceToLight(d), disk.depth - d, disk.texelsPerMetre, roundLight);
    occludes = occludes && (holds || !disk.twoStep);
#endif
    return occludes ? d : disk.depth;
}

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, false, false);
    Disk disk = makeDisk(r, l);
    float radius = float(maxRadius);
    bool centreBelowHorizon = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    bool asks = r.known < 0.0 && !centreBelowHorizon;

    vec2 corner = floor(l.texel);
#if PREPARED
    vec3 own = textureLod(prepared, (corner + 0.5) * lightView.light.w, 0.0).xyz;
#else
    vec3 own = vec3(storedDepth(corner), 1.0, 0.0);
#endif
#ifdef RADIAL_METRIC
    bool hard = own.x < 1.0 && occluderDepth(disk, own.x, corner + 0.5 - l.texel) + disk.bias < disk.depth;
#else
    bool hard = own.x < 1.0 && blocks(l, own.x, vec2(0.0)) > 0.0;
#endif
    hard = hard && ofAnother(disk, corner);
#if TWO_STEP == TWO_STEP_OUTER
    disk.twoStep = !hard;
#endif
    ivec2 start = firstSample(r.pixel);

    // The disk's half size, from the receiver's own occluder or, where it is lit, from the nearest.
    float occluder = hard ? own.x : own.y;
    float sized = occluderDepth(disk, occluder, corner + 0.5 - l.texel);
    vec2 q = diskTexelsHalf(disk, sized, radius);
#if PREPARED
    // A disk of less than a texel is the texel's own answer.
    bool nearby = nearBoundary(own.z, radius, max(q.x, q.y)) && max(q.x, q.y) >= 0.5;
    if (slipEarlyOut) nearby = nearBoundaryAsPrinted(own.z, max(q.x, q.y));
    bool filters = asks && occluder < 1.0 && nearby;
#else
    bool filters = asks;
#if PRE_PROCESSING == PRE_PROCESSING_NONE_CORRECTED
    // The corrected radius of a lit receiver: the greatest difference of depth over the largest disk.
    float nearest = disk.depth;
    int searched = asks && !hard ? maxSamples : 0;
    for (int i = 0; i < searched; ++i) nearest = min(nearest, occluderAt(disk, l.texel, samplePoint(start, i) * radius));
    sized = hard ? sized : nearest;
    q = diskTexelsHalf(disk, sized, radius);
    filters = asks && (hard || nearest < disk.depth);
#else
    sized = hard ? sized : disk.depth;
    q = hard ? q : vec2(1.0); // the least: a texel
#endif
#endif

    float texels = diskTexels(q, roundLight);
    float number = min(sampleCount(texels, texelsPerSample), float(maxSamples));
    // Of a disk that is far from the viewer, no more for each pixel that its area takes on the screen.
    float metresPerPixel = length(view.rayDx.xyz) * r.eyeDepth;
    float pixels = texels / max(disk.texelsPerMetre * disk.texelsPerMetre * metresPerPixel * metresPerPixel, 1e-12);
    number = samplesPerPixel > 0.0 ? min(number, ceil(pixels * samplesPerPixel)) : number;
    int count = filters ? int(max(number, 1.0)) : 0;
    float lit = slipSum && !hard ? 1.0 : 0.0;
    for (int i = 0; i < count; ++i)
        lit += occluderAt(disk, l.texel, samplePoint(start, i) * q) < disk.depth ? 0.0 : 1.0;

    float psi = count > 0 ? clamp(1.0 - lit / float(count), 0.0, 1.0) : hard ? 1.0 : 0.0;
    psi = centreBelowHorizon ? 1.0 : psi;
    bool shadowed = r.known >= 0.0 ? r.known > 0.0 : psi == 1.0 && count == 0 ? true : hard;
    int region = r.eyeDepth > 0.0 ? regionOf(shadowed, count > 0) : regionNone;
    imageStore(regions, r.pixel, vec4(float(region), float(count), 0.0, 0.0));
#ifdef KEEPS_SAMPLES
    // What needs no sample counts as many as there may be, all alike.
    float n = count > 0 ? float(count) : float(maxSamples);
    float d_b = count > 0 ? (sized == 0.0 ? 1e-6 : sized) : 0.0;
    vec4 kept = vec4(n * (r.known >= 0.0 ? r.known : psi), n, r.eyeDepth, d_b);
#ifdef ACCUMULATES
    kept.xy += texelFetch(history, r.pixel, 0).xy;
#endif
    imageStore(samples, r.pixel, r.eyeDepth > 0.0 ? kept : vec4(0.0));
#else
    writeShadow(r, psi);
#endif
}
