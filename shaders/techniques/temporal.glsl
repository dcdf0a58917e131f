// SPDX-License-Identifier: MIT
// One more hard shadow test of every surface, added to its history; see renderer/techniques/temporal.cpp.
//
// Texture reads: depth, normal, map, and 1 (nearest) or 4 (bilinear) of the history; where there is none N_b + N_f more of
// the map.
#define OWN_CONSTANTS                                                                                                      \
    ViewBlock lastView;                                                                                                    \
    vec4 keep; // x = most samples that a history keeps in this frame, y = most that one may have
#include "percentage_closer.glsl"
#include "lib/temporal.glsl"

uniform sampler2D history; // shadowBuffer of the last frame
#ifdef MOTION
uniform sampler2D motion;
#endif
uniform writeonly image2D shadowBuffer; // ρ, n, eye depth [m] (negative: a moving caster's shadow), mean blocker depth [m]

const bool absoluteTest = DEPTH_TEST == DEPTH_TEST_ABSOLUTE;

// Where a surface was in the last frame.
struct Before {
    vec2 place;     // [pixels]
    float eyeDepth; // [m]
};

Before findBefore(Receiver r)
{
    vec3 positionWorld = view.eyeWorld.xyz + r.eyeDepth * r.ray;
    vec4 clip = lastView.clipFromWorld * vec4(positionWorld, 1.0);
    Before b = Before((clip.xy / clip.w * 0.5 + 0.5) * lastView.size.xy, clip.w);
#ifdef MOTION
    // The motion image is in half floats: only things that really moved are taken from it.
    vec3 moved = texelFetch(motion, r.pixel, 0).xyz;
    vec2 place = vec2(r.pixel) + 0.5 + moved.xy;
    if (distance(place, b.place) > 0.02 + 0.002 * length(moved.xy)) b = Before(place, r.eyeDepth + moved.z);
#endif
    return b;
}

vec3 lastRay(vec2 place) { return lastView.rayCorner.xyz + place.x * lastView.rayDx.xyz + place.y * lastView.rayDy.xyz; }

// A mean over those texels of the last frame that show the same surface; n = 0: none does.
struct Found {
    History h;
    float blocker; // [m], 0: not known
    bool tagged;   // the shadow of something that moved
};

Found lookUp(Receiver r, Before b)
{
#if LOOKUP == LOOKUP_BILINEAR
    // A view at rest must not blur, however long: fractions below 1/256 are rounding.
    vec2 corner = floor(b.place - 0.5);
    vec2 f = floor((b.place - 0.5 - corner) * 256.0 + 0.5) / 256.0;
    const int texels = 4;
#else
    vec2 corner = floor(b.place);
    vec2 f = vec2(0.0);
    const int texels = 1;
#endif
    ivec2 size = textureSize(history, 0);
    vec3 centre = lastRay(b.place);
    bool seen = all(greaterThanEqual(b.place, vec2(0.0))) && all(lessThan(b.place, vec2(size)));
    float share = 0.0;
    float blockerShare = 0.0;
    Found found = Found(History(0.0, 0.0), 0.0, false);
    for (int i = 0; i < texels; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        vec2 place = corner + vec2(step);
        float weight = (step.x == 1 ? f.x : 1.0 - f.x) * (step.y == 1 ? f.y : 1.0 - f.y);
        bool inside = seen && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(size)));
        vec4 texel = texelFetch(history, clamp(ivec2(place), ivec2(0), size - 1), 0);
        float expected = depthOnPlane(b.eyeDepth, r.normalWorld, centre, lastRay(place + 0.5));
        bool same = sameSurface(expected, abs(texel.z), absoluteTest ? epsilonMetres : epsilon, !absoluteTest);
        bool counts = inside && same && sound(History(texel.x, texel.y)) && weight > 0.0;
        bool blocked = counts && texel.w != 0.0 && abs(texel.w) < 1e30;
        // Chosen, not multiplied: nothing times NaN is NaN.
        found.h.rho += counts ? weight * texel.x : 0.0;
        found.h.n += counts ? weight * texel.y : 0.0;
        share += counts ? weight : 0.0;
        found.blocker += blocked ? weight * texel.w : 0.0;
        blockerShare += blocked ? weight : 0.0;
        found.tagged = found.tagged || (counts && texel.z < 0.0);
    }
    found.h.rho /= max(share, 1e-6);
    found.h.n /= max(share, 1e-6);
    found.blocker /= max(blockerShare, 1e-6);
    return found;
}

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, false);
    vec2 s = lightView.sample_reference.xy;

    // τ: does the map hide its point of the light?
    bool belowHorizon = directional ? r.facing <= 0.0 : r.facing >= 0.0;
    vec2 corner = floor(l.texel);
    float z = signedDepth(corner);
    bool blocked = r.known < 0.0 && !belowHorizon && blocks(l, abs(z), corner + 0.5 - l.texel) > 0.0;
    float tau = r.known >= 0.0 ? r.known : belowHorizon || blocked ? 1.0 : 0.0;
    bool moving = blocked && z < 0.0;

    Found past = lookUp(r, findBefore(r));
    History h = limited(past.h, keep.x);
    bool tagged = moving;
#if MOVING == MOVING_DISOCCLUSION
    h = limited(h, moving ? 0.0 : h.n);
#elif MOVING == MOVING_DECREMENT
    // Under a moving caster as new; afterwards ever fewer samples, and few at once where there are many.
    History fewer = h.n > dropAbove ? limited(h, float(decrement)) : decremented(h, float(decrement));
    bool over = fewer.n < 1.0;
    bool left = past.tagged && !moving;
    h = limited(h, moving || (left && over) ? 0.0 : left ? fewer.n : h.n);
    tagged = moving || (left && !over);
#endif

    // The start of a surface that has no history.
    bool fresh = h.n <= 0.0;
    History start = History(tau, 1.0);
    float startBlocker = noBlocker;
#if START != START_HARD
    vec2 shift = rotate != 0 ? pixelShift(vec2(r.pixel)) : vec2(0.0);
    vec2 halfLight = lightView.light.xy;
    Lookup nearer = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, true);
    int searched = fresh && r.known < 0.0 ? searchTaps : 0;
    startBlocker = meanBlocker(r, nearer, halfLight, s, shift, searched, 1.0 / float(searchTaps), true);
#endif
#if START == START_PCSS
    int filtered = startBlocker > noBlocker ? filterTaps : 0;
    float psi = filteredShadow(r, nearer, halfLight, s, startBlocker, shift, filtered, 1.0 / float(filterTaps));
    if (halfLight.x + halfLight.y > 0.0) { // a point needs no estimate
        start.n = float(startWeight);
        start.rho = start.n * (r.known >= 0.0 ? r.known : psi);
    }
#endif
    bool found = startBlocker > noBlocker;
    float blocker = fresh ? (found ? startBlocker : 0.0) : past.blocker;
    if (fresh)
        h = start;
    else
        h = withSample(h, tau, keep.y);

    float d = axialDepth(abs(z));
    float refined = blocker == 0.0 ? d : withBlocker(blocker, d, h.n, float(blockerWeight));
    blocker = blocked && !(fresh && found) ? refined : blocker;

    // Directional depths may be 0, which means that nothing blocks.
    blocker = blocked && blocker == 0.0 ? 1e-6 : blocker;
    bool surface = r.eyeDepth > 0.0;
    imageStore(shadowBuffer, r.pixel, surface ? vec4(h.rho, h.n, tagged ? -r.eyeDepth : r.eyeDepth, blocker) : vec4(0.0));
}
