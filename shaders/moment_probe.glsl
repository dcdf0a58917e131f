// SPDX-License-Identifier: MIT
// What a pixel's kernel holds: the distribution F(z) of its depths, texel by texel, and over it what every member of the
// family makes of them, free of the rounding of formats (Peters and Klein 2015, figures 2 and 3). A column is a depth.
#include "moment_lookup.glsl"
#include "lib/moments_six.glsl"
#include "lib/moments_trigonometric.glsl"
#include "lib/convolution.glsl"
#include "lib/slices.glsl"

uniform writeonly image2D kernelDepths, kernelBounds, kernelWarps;

// The texels that a bilinear lookup of the filtered map takes part of.
struct Kernel {
    int half_n, side;
    vec2 corner, share; // of the lower left of the four in its middle, and how far beyond it the place is
};
struct Texel {
    float weight, z;
};
Texel texelOf(Kernel k, int i)
{
    ivec2 place = ivec2(i % k.side, i / k.side) - k.half_n;
    float weight = bilinearWeight(place.x, k.half_n, k.share.x) * bilinearWeight(place.y, k.half_n, k.share.y);
    return Texel(weight, storedDepth(k.corner + vec2(place)));
}

void main()
{
    ivec2 column = texelHere().xy;
    Receiver r = findReceiverOf(lookup.probed.xy, normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, false, false);
    float z_f = l.compared - l.offset;
    Kernel pixelKernel;
    pixelKernel.half_n = lookup.probed.z;
    pixelKernel.side = 2 * pixelKernel.half_n + 2;
    pixelKernel.corner = floor(l.texel - 0.5);
    pixelKernel.share = l.texel - 0.5 - pixelKernel.corner;
    int texels = pixelKernel.side * pixelKernel.side;

    float nearest = z_f;
    float farthest = z_f;
    for (int i = 0; i < texels; ++i) {
        Texel t = texelOf(pixelKernel, i);
        nearest = t.weight > 0.0 ? min(nearest, t.z) : nearest;
        farthest = t.weight > 0.0 ? max(farthest, t.z) : farthest;
    }
    float t = depthOfColumn(column.x, probeColumns, nearest, farthest, z_f);

    float inFront = 0.0;
    vec4 low = vec4(0.0), high = vec4(0.0), turns = vec4(0.0), warps = vec4(0.0);
    vec4 slices[2] = vec4[2](vec4(0.0), vec4(0.0));
    float exponential = 0.0, visible = 0.0;
    const vec2 c = vec2(40.0, 5.0); // EVSM
    const float esm = 80.0;
    const int terms = 16;
    const float trigonometricMargin = 0.1, overlap = 0.05;
    for (int i = 0; i < texels; ++i) {
        Texel texel = texelOf(pixelKernel, i);
        float w = texel.weight;
        float z = texel.z;
        inFront += z < t ? w : 0.0;
        float s = 2.0 * z - 1.0;
        vec4 powers = powersOf(s);
        low += w * powers;
        high += w * powers * powers.w;
        turns += w * trigonometricOf(mix(trigonometricMargin, 1.0, z));
        vec2 e = vec2(exp(c.x * s), -exp(-c.y * s));
        warps += w * vec4(e.x, e.x * e.x, e.y, e.y * e.y);
        exponential += w * exp(esm * (z - t));
        slices[0] += w * slicesOf(z, 0, 4.0, overlap);
        slices[1] += w * slicesOf(z, 1, 4.0, overlap);
        float square = 0.5;
        for (int k = 1; k <= terms; ++k) {
            float a = 3.14159265 * float(2 * k - 1);
            float order = float(k) / float(terms);
            square += 2.0 / a * exp(-order * order) * sin(a * (z - t) * 0.9);
        }
        visible += w * square;
    }

    float v = 2.0 * t - 1.0;
    const float alpha = 3e-7;
    vec4 biased = mix(low, vec4(0.0, 0.375, 0.0, 0.375), alpha);
    DepthRange range = DepthRange(-1.0, 1.0, 1e-7, 1e-9);
    const float six = 1e-5;
    vec4 lowSix = mix(low, vec4(0.0, 0.5, 0.0, 0.375), six);
    vec2 highSix = mix(high.xy, vec2(0.0, 0.3125), six);
    float variance = varianceBound(low.xy, v, 1e-7);
    float hamburger = hamburgerBound(biased, v, range);
    float hausdorff = hausdorffBound(biased, v, range);
    float sixth = sixMomentsBound(SixMoments(lowSix.x, lowSix.y, lowSix.z, lowSix.w, highSix.x, highSix.y), v,
                                  max(six * vec3(0.5, 0.125, 0.03125), vec3(1e-7, 1e-8, 1e-9)));
    float trigonometric = trigonometricBound((1.0 - 1e-5) * turns, mix(trigonometricMargin, 1.0, t), 1e-5);
    vec2 deviation = 2.0 * 5e-5 * c;
    float warped = max(warpedVarianceBound(warps.xy, exp(c.x * v), deviation.x),
                       warpedVarianceBound(warps.zw, -exp(-c.y * v), deviation.y));
    float layered = 0.0;
    for (int pair = 0; pair < 2; ++pair) {
        vec4 own = slicesOf(t, pair, 4.0, overlap);
        layered = max(layered, max(varianceBound(slices[pair].xy, own.x, 1e-6), varianceBound(slices[pair].zw, own.z, 1e-6)));
    }
    imageStore(kernelDepths, column, vec4(t, inFront, z_f, clamp(1.0 - visible, 0.0, 1.0)));
    imageStore(kernelBounds, column, vec4(variance, hamburger, hausdorff, sixth));
    imageStore(kernelWarps, column, vec4(trigonometric, clamp(1.0 - exponential, 0.0, 1.0), warped, layered));
}
