// SPDX-License-Identifier: MIT
// The comparison z ≥ t as a Fourier series (Annen et al. 2007): with c_k = π (2k − 1) and |z − t| < 1
//     S(z − t) = ½ + Σ_k 2/c_k sin(c_k (z − t)),  sin(c_k (z − t)) = sin(c_k z) cos(c_k t) − cos(c_k z) sin(c_k t)
// is linear in functions of z alone, which can be filtered. The terms 2n + 1 and 2n + 2 share layer n.

// sin and cos of both terms. Turns, not radians: the sine of a large angle is a poor one on many drivers.
vec4 squareWaveOf(float z, int layer)
{
    float turns = 0.5f * z * float(4 * layer + 1);
    float next = turns + z;
    float a = 6.2831853f * (turns - floor(turns));
    float b = 6.2831853f * (next - floor(next));
    return vec4(sin(a), cos(a), sin(b), cos(b));
}

// A layer's part of E S(z − t) − ½ of the filtered means. Term k of `terms` is weakened by exp(−a (k / terms)²), which
// takes the edge of the series' ripples.
float squareWaveAt(vec4 means, float t, int layer, int terms, float attenuation)
{
    vec4 own = squareWaveOf(t, layer);
    float k = float(2 * layer + 1);
    float share = k / float(terms);
    float nextShare = (k + 1.0f) / float(terms);
    float first = (means.x * own.y - means.y * own.x) / (2.0f * k - 1.0f) * exp(-attenuation * share * share);
    float second = (means.z * own.w - means.w * own.z) / (2.0f * k + 1.0f) * exp(-attenuation * nextShare * nextShare);
    return 0.63661977f * (first + (2 * layer + 2 <= terms ? second : 0.0f));
}
