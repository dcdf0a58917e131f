// SPDX-License-Identifier: MIT
// One more hard shadow test of every surface, added to its history; see renderer/techniques/temporal.cpp.
//
// Texture reads: depth, normal, each of the MAPS maps, and 1 (nearest) or 4 (bilinear) of the history.
#ifdef MAPS
#define FURTHER_VIEWS /* sample_reference and window of the second map and those after it */ vec4 furtherViews[2 * (MAPS - 1)];
#else
#define FURTHER_VIEWS
#endif
#define OWN_CONSTANTS                                                                                                      \
    vec4 lastX, lastY, lastForward; /* from a place relative to the eye [m] to last frame's: d (x, y) [pixels], d [m] */   \
    vec4 lastRayCorner, lastRayDx, lastRayDy; /* of last frame's view */                                                   \
    vec4 keep; /* most samples that a history keeps: x in this frame, z if its surface moves; y = that it may have */      \
    vec4 picture; /* xy of its first pixel in the buffer */                                                                \
    FURTHER_VIEWS
#include "shadow_lookup.glsl"
#include "techniques/temporal_mixing.glsl"

uniform sampler2D history; // shadowBuffer of the last frame
#ifdef MAPS
uniform sampler2D furtherMaps[MAPS - 1];
#endif
#ifdef MOTION
uniform sampler2D motion;
#endif
#ifdef MOVERS
uniform sampler2D movers; // 1: something that moves takes light
#endif
uniform writeonly image2D shadowBuffer; // ρ, n, eye depth [m] (negative: a moving caster's shadow), mean blocker depth [m]
#ifdef STARTED
TILE_SET(startingTiles, starting)
#endif
#ifdef FILTERED
TILE_SET(askingTiles, asking)
#endif
#ifdef INSPECTED
uniform writeonly image2D test; // τ (a mean over the maps), what became of the history, xy the light's point in half sizes
#endif

const bool absoluteTest = DEPTH_TEST == DEPTH_TEST_ABSOLUTE;

// A mean over those texels of the last frame that show the same surface; n = 0: none does.
struct Found {
    History h;
    float blocker; // [m], 0: not known
    bool tagged;   // the shadow of something that moved
    float share, blockerShare; // of the texels
    vec2 place;                // of the surface in the last frame [pixels]
    bool moves;                // by itself
};

// Fetches outside the buffer are 0, which is no history. What does not count is left out by choice: nothing times NaN is
// NaN.
void addTexel(inout Found found, ivec2 place, float weight, float d, float tilt)
{
    vec4 texel = texelFetch(history, place, 0);
    bool same = samePlane(d, tilt, abs(texel.z), absoluteTest ? epsilonMetres : epsilon, !absoluteTest);
    float w = same && sound(History(texel.x, texel.y)) ? weight : 0.0;
    float w_b = texel.w != 0.0 && abs(texel.w) < 1e30 ? w : 0.0;
    found.h.rho += w > 0.0 ? w * texel.x : 0.0;
    found.h.n += w > 0.0 ? w * texel.y : 0.0;
    found.share += w;
    found.blocker += w_b > 0.0 ? w_b * texel.w : 0.0;
    found.blockerShare += w_b;
    found.tagged = found.tagged || (w > 0.0 && texel.z < 0.0);
}

Found lookUp(Receiver r)
{
    Found found = Found(History(0.0, 0.0), 0.0, false, 0.0, 0.0, vec2(r.pixel) + 0.5, false);
#ifdef STILL
    // Nothing has moved: the texel is the pixel's own, and shows the same surface.
    vec4 texel = texelFetch(history, r.pixel, 0);
    bool known = sound(History(texel.x, texel.y));
    found.h.rho = known ? texel.x : 0.0;
    found.h.n = known ? texel.y : 0.0;
    found.blocker = known && abs(texel.w) < 1e30 ? texel.w : 0.0;
    return found;
#else
    // Where the surface was in the last frame [pixels], and its eye depth.
    vec3 fromEye = r.eyeDepth * r.ray;
    float d = dot(lastForward.xyz, fromEye) + lastForward.w;
    vec2 place = vec2(dot(lastX.xyz, fromEye) + lastX.w, dot(lastY.xyz, fromEye) + lastY.w) / d;
#ifdef MOTION
    // The motion image is in half floats: only things that really moved are taken from it.
    vec3 moved = texelFetch(motion, r.pixel, 0).xyz;
    vec2 there = vec2(r.pixel) + 0.5 + moved.xy;
    found.moves = distance(there, place) > 0.02 + 0.002 * length(moved.xy);
    place = found.moves ? there : place;
    d = found.moves ? r.eyeDepth + moved.z : d;
#endif
    found.place = place;
    // How the products of the surface's normal with the rays of the last view change, relative to the one at `place`.
    vec2 tilts = vec2(dot(r.normalWorld, lastRayDx.xyz), dot(r.normalWorld, lastRayDy.xyz));
    float along = dot(r.normalWorld, lastRayCorner.xyz) + dot(place, tilts);
    tilts /= along;
#if LOOKUP == LOOKUP_BILINEAR
    // A view at rest must not blur, however long: fractions below 1/256 are rounding.
    vec2 corner = floor(place - 0.5);
    vec2 f = floor((place - 0.5 - corner) * 256.0 + 0.5) / 256.0;
    float tilt = 1.0 + dot(corner + 0.5 - place, tilts);
    ivec2 texel = ivec2(corner);
    addTexel(found, texel, (1.0 - f.x) * (1.0 - f.y), d, tilt);
    addTexel(found, texel + ivec2(1, 0), f.x * (1.0 - f.y), d, tilt + tilts.x);
    addTexel(found, texel + ivec2(0, 1), (1.0 - f.x) * f.y, d, tilt + tilts.y);
    addTexel(found, texel + ivec2(1, 1), f.x * f.y, d, tilt + tilts.x + tilts.y);
    float whole = 1.0 / max(found.share, 1e-6);
    found.h.rho *= whole;
    found.h.n *= whole;
    found.blocker /= max(found.blockerShare, 1e-6);
#else
    addTexel(found, ivec2(floor(place)), 1.0, d, 1.0 + dot(floor(place) + 0.5 - place, tilts));
#endif
    return found;
#endif
}

#ifdef INSPECTED
// The order of eventNames in temporal.cpp.
float eventOf(Found past, bool known, bool fresh, bool moving, bool tagged)
{
    bool outside = any(lessThan(past.place, vec2(0.0))) || any(greaterThanEqual(past.place, vec2(textureSize(history, 0))));
    bool nothing = texelFetch(history, ivec2(floor(past.place)), 0).y == 0.0;
    float why = outside ? 2.0 : nothing ? 4.0 : 3.0;
    return !known ? 0.0 : moving && MOVING != MOVING_IGNORE ? 5.0 : fresh ? why : tagged ? 6.0 : 1.0;
}
#endif

// Does a map hide its point of the light?
struct Test {
    float tau;
    bool blocked;
    float z; // what is stored
};

Test testIn(sampler2D map, Receiver r)
{
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, false);
    bool belowHorizon = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    vec2 corner = floor(l.texel);
    float z = signedDepthIn(map, corner);
    bool blocked = r.known < 0.0 && !belowHorizon && blocks(l, abs(z), corner + 0.5 - l.texel) > 0.0;
    return Test(r.known >= 0.0 ? r.known : belowHorizon || blocked ? 1.0 : 0.0, blocked, z);
}

// The mean blocker depth of a history of n tests, with the last one's. Directional depths may be 0, which means that
// nothing blocks.
float withDepth(float blocker, Test test, float n)
{
    float d = axialDepth(abs(test.z));
    float refined = blocker == 0.0 ? d : withBlocker(blocker, d, n, float(blockerWeight));
    return !test.blocked ? blocker : refined == 0.0 ? 1e-6 : refined;
}

#ifdef MAPS
// A further map of the same light; the surface keeps the first one's offset along its normal.
void addMap(sampler2D map, int further, inout Receiver r, inout History h, inout float blocker, inout float taus)
{
    lightView.sample_reference = furtherViews[2 * further];
    lightView.window = furtherViews[2 * further + 1];
    lookFrom(lightView.sample_reference.xy, r);
    Test test = testIn(map, r);
    h = withSample(h, test.tau, keep.y);
    blocker = withDepth(blocker, test, h.n);
    taus += test.tau;
}
#define FURTHER(i) if (i < MAPS - 1) addMap(furtherMaps[min(i, MAPS - 2)], min(i, MAPS - 2), r, h, blocker, tau);
#endif

void main()
{
    Receiver r = findReceiver(normalOffset);
    Test first = testIn(shadowMap, r);
    float tau = first.tau;
    bool moving = first.blocked && first.z < 0.0;
#ifdef MOVERS
    moving = texelFetch(movers, r.pixel, 0).x > 0.0;
#endif

    Found past = lookUp(r);
    History h = limited(past.h, past.moves ? min(keep.x, keep.z) : keep.x);
    bool tagged = moving;
#if MOVING == MOVING_DISOCCLUSION
    h = limited(h, moving ? 0.0 : h.n);
#elif MOVING == MOVING_REGION
    // The shadow that a frame has is not that of the next, neither under it nor where it has just been.
    h = limited(h, moving || past.tagged ? 0.0 : h.n);
#elif MOVING == MOVING_DECREMENT
    // Under a moving caster as new; afterwards ever fewer samples, and few at once where there are many.
    History fewer = h.n > dropAbove ? limited(h, float(decrement)) : decremented(h, float(decrement));
    bool over = fewer.n < 1.0;
    bool left = past.tagged && !moving;
    h = limited(h, moving || (left && over) ? 0.0 : left ? fewer.n : h.n);
    tagged = moving || (left && !over);
#endif

    bool fresh = h.n <= 0.0;
    h = fresh ? History(tau, 1.0) : withSample(h, tau, keep.y);
#if START == START_PCSS && defined(STARTED)
    // A point of light needs no estimate.
    float weight = fresh && lightView.light.x + lightView.light.y > 0.0 ? float(startWeight) : 1.0;
    h = History(weight * h.rho, weight == 1.0 ? h.n : weight);
#endif
    float blocker = withDepth(fresh ? 0.0 : past.blocker, first, h.n);
#ifdef MAPS
    // No loop: with constant indices all of it is one block of arithmetic.
    FURTHER(0) FURTHER(1) FURTHER(2) FURTHER(3) FURTHER(4) FURTHER(5)
    FURTHER(6) FURTHER(7) FURTHER(8) FURTHER(9) FURTHER(10)
    tau /= float(MAPS);
#endif
    float depthTag = tagged ? -r.eyeDepth : r.eyeDepth;
    bool surface = r.eyeDepth > 0.0;
#ifdef STARTED
    bool starts = fresh && r.known < 0.0;
#else
    bool starts = false;
#endif
    vec4 kept = vec4(h.rho, starts ? -h.n : h.n, depthTag, blocker);
    imageStore(shadowBuffer, r.pixel, surface ? kept : vec4(0.0));
    ivec2 pixel = r.pixel - ivec2(picture.xy);
    imageStore(shadow, pixel, vec4(surface ? clamp(estimated(h), 0.0, 1.0) : 0.0));
#ifdef STARTED
    if (starts) MARK(starting, r.pixel)
#endif
#ifdef FILTERED
    if (surface && !starts && asksNeighbours(h, blocker, visibleAt(r.pixel))) MARK(asking, pixel)
#endif
#ifdef INSPECTED
    vec2 point = lightView.sample_reference.xy / max(lightView.light.xy, vec2(1e-9)); // of the last map
    imageStore(test, r.pixel, vec4(tau, eventOf(past, surface, fresh, moving, tagged), point));
#endif
}
