// SPDX-License-Identifier: MIT
// What is shown of the shadow buffer: ψ̂ where its error is small, else a mean over the neighbours that lie on the same
// surface, as wide as the penumbra. Stores nothing that a later frame reads. See renderer/techniques/temporal.cpp.
//
// Runs over the tiles in which a pixel asks its neighbours. Texture reads: 1 of the buffer and the normal, and one a tap.
#define OWN_CONSTANTS                                                                                                      \
    vec4 forward_scale; /* xyz the view axis, w = pixels² per m² at eye depth 1 */                                         \
    vec4 probed;        // xy the pixel that is looked at closely
#include "resolve.glsl"
#include "techniques/temporal_mixing.glsl"
#include "lib/sampling.glsl"

uniform sampler2D shadowBuffer;
#ifdef INSPECTED
uniform sampler2D test;
uniform writeonly image2D state; // what is shown or why it is new, share of the neighbours, ŝ, ψ̂
#endif
#ifdef PROBED
uniform writeonly image2D neighbours; // of the probed pixel: xy [pixels], whether it counts
#endif

vec2 entry(int i)
{
    vec4 pair = table[i >> 1];
    return (i & 1) == 0 ? pair.xy : pair.zw;
}

// From a displacement of the point at `depth` along `ray` [m] to one on the screen [pixels].
vec2 pixelsOf(vec3 across, vec3 ray, float depth)
{
    vec3 aside = across - dot(across, forward_scale.xyz) * ray;
    return vec2(dot(aside, view.rayDx.xyz), dot(aside, view.rayDy.xyz)) * (forward_scale.w / depth);
}

void main()
{
    ivec2 pixel = texelHere().xy;
    ivec2 texel = surfaceTexel(pixel);
    vec4 here = texelFetch(shadowBuffer, texel, 0);
    History h = History(here.x, here.y);
    float eyeDepth = abs(here.z);

    float visible = visibleAt(texel);
    float sampled = sampledOf(h, visible);
    History sum = h;
#ifdef PROBED
    int asks = 0; // neighbours
#endif
    if (NEIGHBOURHOOD != NEIGHBOURHOOD_OFF && eyeDepth > 0.0 && asksNeighbours(h, here.w, visible)) {
        vec3 n = unitFromOctahedral(texelFetch(normal, texel, 0).xy);
        vec2 centre = vec2(texel) + 0.5;
        vec3 ray = view.rayCorner.xyz + centre.x * view.rayDx.xyz + centre.y * view.rayDy.xyz;

        // Half the penumbra's width on a plane parallel to the light: r (d_r − d_b) / d_b, directional r (d_r − d_b).
        vec3 positionLight = (lightView.lightFromWorld * vec4(view.eyeWorld.xyz + eyeDepth * ray, 1.0)).xyz;
        float d_r = directional ? -positionLight.z : max(-positionLight.z, 0.0);
        float gap = max(d_r - here.w, 0.0);
        vec2 halfWidth = radiusScale * lightView.light.xy * (directional ? gap : gap / max(here.w, 1e-6));
#if FOOTPRINT == FOOTPRINT_SURFACE
        mat3 worldFromLight = transpose(mat3(lightView.lightFromWorld));
        vec3 towards = worldFromLight * normalize(directional ? vec3(0.0, 0.0, 1.0) : -positionLight);
        vec2 axisX = pixelsOf(alongSurface(worldFromLight[0] * halfWidth.x, towards, n), ray, max(eyeDepth, 1e-6));
        vec2 axisY = pixelsOf(alongSurface(worldFromLight[1] * halfWidth.y, towards, n), ray, max(eyeDepth, 1e-6));
#else
        // Equation 6, and 5.6 with 5.9 and 5.10: a circle on the screen.
        float radius = halfWidth.x * sqrt(forward_scale.w) / max(eyeDepth, 1e-6);
        vec2 axisX = vec2(radius, 0.0);
        vec2 axisY = vec2(0.0, radius);
#endif
        // Not wider than a quarter of the picture.
        float longest = max(max(length(axisX), length(axisY)), 1e-6);
        float shrink = min(1.0, 0.25 * float(textureSize(shadowBuffer, 0).y) / longest);
        axisX *= shrink;
        axisY *= shrink;
        sampled = longest > 0.5 ? sampled : 1.0;
        // As many samples in all whatever their number in a pixel, where neighbours may be fewer.
        float asked = thinOut != 0 && h.n > float(fewSamples) ? max(float(fewSamples), 1.0) / h.n : 1.0;
        int count = longest > 0.5 ? int(ceil(float(taps) * asked)) : 0;

        // Turned by up to a quarter to either side, as the tangent of half the angle has it.
        float tangent = turn != 0 ? 2.0 * gradientNoise(vec2(pixel)) - 1.0 : 0.0;
        vec2 spin = vec2(1.0 - tangent * tangent, 2.0 * tangent) / (1.0 + tangent * tangent);
#if NEIGHBOURHOOD == NEIGHBOURHOOD_BOX
        float share = 1.0 / max(float(count), 1.0);
        vec2 state = turn != 0 ? pixelShift(vec2(pixel)) : vec2(0.0);
#endif
        // How the products of the normal with the rays change from pixel to pixel.
        vec2 tilts = vec2(dot(n, view.rayDx.xyz), dot(n, view.rayDy.xyz)) / dot(n, ray);
        for (int i = 0; i < count; ++i) {
#if NEIGHBOURHOOD == NEIGHBOURHOOD_BOX
            state = latticeNext(state, share);
            vec2 o = 2.0 * state - 1.0;
#else
            vec2 o = entry(i);
            o = vec2(spin.x * o.x - spin.y * o.y, spin.y * o.x + spin.x * o.y);
#endif
            vec2 step = floor(centre + o.x * axisX + o.y * axisY) - vec2(texel);
            vec4 other = texelFetch(shadowBuffer, texel + ivec2(step), 0); // outside it is 0, which is no history
#if FOOTPRINT == FOOTPRINT_SURFACE
            bool same = samePlane(eyeDepth, 1.0 + dot(step, tilts), abs(other.z), neighbourEpsilon, true);
#else
            bool same = sameSurface(eyeDepth, abs(other.z), neighbourEpsilon, true);
#endif
            bool counts = same && sound(History(other.x, other.y));
            sum.rho += counts ? other.x : 0.0;
            sum.n += counts ? other.y : 0.0;
#ifdef PROBED
            if (pixel == ivec2(probed.xy)) imageStore(neighbours, ivec2(i, 0), vec4(step, counts ? 1.0 : 0.0, 0.0));
#endif
        }
#ifdef PROBED
        asks = count;
#endif
    }
    float psi = mix(estimated(sum), estimated(h), sampled);
    imageStore(shadow, pixel, vec4(eyeDepth > 0.0 ? clamp(psi, 0.0, 1.0) : 0.0));
#ifdef INSPECTED
    float filtered = sum.n > h.n ? 1.0 - sampled : 0.0;
    float event = texelFetch(test, texel, 0).y;
    // The order of stateNames in temporal.cpp: of a history that goes on, how it is shown.
    float kind = event == 0.0 ? 0.0 : event > 1.0 ? event + 2.0 : filtered == 0.0 ? 1.0 : filtered == 1.0 ? 3.0 : 2.0;
    imageStore(state, pixel, vec4(kind, filtered, eyeDepth > 0.0 ? standardError(h) : 0.0, estimated(h)));
#endif
#ifdef PROBED
    for (int i = asks; i < 2 * TABLE && pixel == ivec2(probed.xy); ++i)
        imageStore(neighbours, ivec2(i, 0), vec4(0.0, 0.0, -1.0, 0.0));
#endif
}
