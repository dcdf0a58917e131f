// SPDX-License-Identifier: MIT
// The arithmetic of soft shadows by temporal coherence (Scherzer, Schwärzler, Mattausch, Wimmer 2009; Schwärzler's thesis
// 2009, chapter 5). A history is ρ_n = Σ τ_i, the sum of n hard shadow tests τ in {0, 1}, and n itself.
struct History {
    float rho;
    float n;
};

// Whether it can be one: what a NaN, an infinity or a cleared texel left behind cannot.
bool sound(History h)
{
    return h.n > 0.0f && h.n < 3.0e7f && h.rho >= 0.0f && h.rho <= h.n;
}

// ψ̂_n, equations 2 and 5; 0 without samples.
float estimated(History h)
{
    return h.n > 0.0f ? h.rho / h.n : 0.0f;
}

// ŝ, equation 3, of the mean of n tests. A single test says nothing about its error (0/0): 1.
float standardError(History h)
{
    float psi = estimated(h);
    return h.n < 2.0f ? 1.0f : sqrt(max(psi * (1.0f - psi), 0.0f) / (h.n - 1.0f));
}

// The same with one lit and one shadowed test added (Laplace's rule): not 0 where the first n tests agree by chance, as
// they do with probability ψ^n + (1 − ψ)^n.
float cautiousError(History h)
{
    float psi = (h.rho + 1.0f) / (h.n + 2.0f);
    return sqrt(psi * (1.0f - psi) / (h.n + 3.0f));
}

// One more test. At `most` counting stops and ψ̂ stays: a sum that rounds (16-bit floats from 2048 on) would drift to 1.
History withSample(History h, float tau, float most)
{
    bool full = h.n + 1.0f > most;
    h.rho += full ? 0.0f : tau;
    h.n += full ? 0.0f : 1.0f;
    return h;
}

// The same ψ̂ said to be the mean of no more than `most` tests, so that new ones weigh more.
History limited(History h, float most)
{
    float share = h.n > most ? most / h.n : 1.0f;
    h.rho *= share;
    h.n *= share;
    return h;
}

// Equations 5.15 to 5.17 of the thesis: Δ tests fewer, of the same mean; none are left below 0.
History decremented(History h, float delta)
{
    return limited(h, max(h.n - delta, 0.0f));
}

// The thesis's w, equation 5.13: the share that the sampled shadow has in what is shown. 1 below sMin, 0 above sMax; with
// sMin = sMax the paper's threshold.
float sampledShare(float error, float sMin, float sMax)
{
    float above = error - sMin;
    return above <= 0.0f ? 1.0f : above >= sMax - sMin ? 0.0f : 1.0f - above / (sMax - sMin);
}

// Equation 7 (5.7 and 5.8 of the thesis): the mean blocker depth with the i-th frame's depth; its first value came from k
// texels.
float withBlocker(float mean, float depth, float i, float k)
{
    return (depth + mean * (i - 1.0f + k)) / (i + k);
}

// Equation 4 and, relative, 5.18: whether two eye depths are of one surface. False for NaN.
bool sameSurface(float expected, float stored, float epsilon, bool relative)
{
    return abs(stored - expected) < (relative ? epsilon * abs(stored) : epsilon);
}

// The same for a neighbouring pixel, of which the surface's plane is asked and not its depth: the plane that this pixel's
// ray r meets at depth d is met by the ray r' at d / tilt, tilt = n·r' / n·r. Seen edge on (a factor of two from pixel to
// pixel) it is d. Without a division; false for NaN.
bool samePlane(float d, float tilt, float stored, float epsilon, bool relative)
{
    float level = tilt > 0.5f && tilt < 2.0f ? tilt : 1.0f;
    float found = stored * level;
    return abs(found - d) < epsilon * (relative ? abs(found) : level);
}

// Where the penumbra's edge falls: what a blocker's shadow moves by on the receiver's plane of normal n while the light's
// point moves by `across`, with `towards` the unit vector to the light. Shears of more than 20 are cut off.
vec3 alongSurface(vec3 across, vec3 towards, vec3 n)
{
    float facing = dot(n, towards);
    return across - towards * (dot(n, across) / max(facing, 0.05f));
}
