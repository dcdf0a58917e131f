// SPDX-License-Identifier: MIT
// What moments of the depths in a filter's kernel tell about ψ(z_f) = P(z < z_f), the share of them in front of a fragment:
// sharp bounds by Chebyshev, Markov and Stieltjes (Donnelly and Lauritzen 2006; Peters and Klein 2015).
//
// Sums of products that cancel are fma(), which is one rounding less where it is fused and right where it is not.

// b = (z, z², z³, z⁴)
vec4 powersOf(float z)
{
    float square = z * z;
    return vec4(z, square, square * z, square * square);
}

// A share of the depths, whatever rounding has made of it: in [0, 1], and 0 for NaN.
float asShare(float psi) { return psi > 0.0f ? min(psi, 1.0f) : 0.0f; }

// Cantelli's inequality for b = E(z, z²): the least ψ that any depths of these moments have.
float varianceBound(vec2 b, float z_f, float leastVariance)
{
    float variance = max(fma(-b.x, b.x, b.y), leastVariance);
    float gap = max(z_f - b.x, 0.0f);
    return gap * gap / fma(gap, gap, variance);
}

// What lies in front of a fragment: the share ψ of the depths, and ψ times their mean.
struct InFront {
    float psi;
    float moment;
};

// By the distribution of Cantelli's inequality: an atom at the fragment and one in front of it.
InFront varianceInFront(vec2 b, float z_f, float leastVariance)
{
    float variance = max(fma(-b.x, b.x, b.y), leastVariance);
    float gap = max(z_f - b.x, 0.0f);
    float all = fma(gap, gap, variance);
    InFront f;
    f.psi = gap * gap / all;
    f.moment = gap * fma(gap, b.x, -variance) / all;
    return f;
}

// The same where depth is warped by a function that grows with it so fast that its square may be as large as a float can be,
// or as small: all is scaled by w, the fragment's warped depth, or the mean. The deviation is at least so many w.
float warpedVarianceBound(vec2 b, float w, float leastDeviation)
{
    float scale = 1.0f / max(abs(w), abs(b.x));
    float mean = b.x * scale;
    float least = max(leastDeviation * w * scale, 1e-7f); // what rounding may leave of mean² − mean²
    float variance = max(fma(-mean, mean, b.y * scale * scale), least * least);
    float gap = max(w * scale - mean, 0.0f);
    return gap * gap / fma(gap, gap, variance);
}

// Visibility below `a` counts as none: ψ grows by 1 / (1 − a) (Lauritzen 2007, light-bleeding reduction).
float withoutBleeding(float psi, float a)
{
    return min(psi / (1.0f - a), 1.0f);
}

// Where depths can lie, and what rounding must not be taken for.
struct DepthRange {
    float low, high;
    float leastVariance; // the variance never falls below this: what bias leaves a single surface, or rounding
    float leastPivot;    // nor the last pivot D33 of the moment problem, which is 0 for one or two depths
};

// b = E(z, z², z³, z⁴) as the distribution of the standardised depth v = (z − mean) / σ, whose first moments are
// 0, 1, γ, δ + γ² + 1. Of the factors L D Lᵀ of the moments' Hankel matrix: σ² = D22, γ = (L32 − 2 mean) / σ, δ = D33 / σ⁴.
struct Standardised {
    float mean;
    float perSigma; // 1 / σ
    float skew;     // γ
    float spread;   // δ > 0; 0 for two depths
    float kurtosis; // E v⁴, without the floor under δ
};

Standardised standardised(vec4 b, DepthRange range)
{
    float variance = max(fma(-b.x, b.x, b.y), range.leastVariance);
    float coupled = fma(-b.x, b.y, b.z); // E z³ − E z E z²
    // The slope of the regression of z² on z lies between those at the ends of the range.
    float l32 = clamp(coupled / variance, 2.0f * range.low, 2.0f * range.high);
    float pivot = fma(-l32, fma(2.0f, coupled, -l32 * variance), fma(-b.y, b.y, b.w));
    Standardised s;
    s.mean = b.x;
    s.perSigma = inversesqrt(variance);
    s.skew = fma(-2.0f, b.x, l32) * s.perSigma;
    s.spread = max(pivot, range.leastPivot) / (variance * variance);
    s.kurtosis = pivot / (variance * variance) + fma(s.skew, s.skew, 1.0f);
    return s;
}

// The distribution of three atoms that has one of them at v and the moments of s: the one that puts least in front of v.
// The other atoms are the roots of k u² + (δ v − γ k) u + δ − k with k = v² − γ v − 1. The one farther from the mean passes
// through infinity as k changes its sign, so it is known by its reciprocal.
struct ThreeAtoms {
    float v;
    float weight; // of the atom at v
    float others; // 1 − weight, without cancellation
    float near;   // the root nearer to the mean
    float perFar; // 1 / the other root
};

ThreeAtoms threeAtoms(Standardised s, float v)
{
    float k = fma(v, v - s.skew, -1.0f);
    float linear = fma(s.spread, v, -s.skew * k);
    float constant = s.spread - k;
    // Two real roots have a positive discriminant; two that nearly meet may lose it to rounding.
    float root = sqrt(max(fma(linear, linear, -4.0f * k * constant), 0.0f));
    float q = -0.5f * (linear + (linear < 0.0f ? -root : root));
    float all = fma(s.spread, fma(v, v, 1.0f), k * k);
    ThreeAtoms a;
    a.v = v;
    a.weight = s.spread / all;
    a.others = fma(k, k, s.spread * v * v) / all;
    a.near = constant / q;
    a.perFar = k / q;
    return a;
}

// What lies in front of v, as rounding leaves it: nothing, the lowest atom, or both others. Weight times place stays finite
// where the atom does not.
InFront inFrontOf(ThreeAtoms a)
{
    bool farIsLowest = a.perFar < 0.0f;
    bool none = farIsLowest ? a.v * a.perFar >= 1.0f : a.v <= a.near;
    bool both = farIsLowest ? a.v > a.near : a.v * a.perFar > 1.0f;
    float apart = fma(-a.near, a.perFar, 1.0f);
    float far = -fma(a.others, a.near, a.weight * a.v) / apart; // its weight times its place; the mean of all three is 0
    float near = fma(a.weight * a.v, a.perFar, a.others) / apart; // its weight
    InFront f;
    f.psi = none ? 0.0f : both ? a.others : farIsLowest ? a.perFar * far : near;
    f.moment = both ? -a.weight * a.v : farIsLowest ? far : near * a.near;
    return f;
}

float weightInFront(ThreeAtoms a) { return asShare(inFrontOf(a).psi); }

// Hamburger's moment problem (Peters and Klein 2015, algorithm 3): the least ψ of depths anywhere on the real line.
float hamburgerBound(vec4 b, float z_f, DepthRange range)
{
    Standardised s = standardised(b, range);
    return weightInFront(threeAtoms(s, (z_f - s.mean) * s.perSigma));
}

InFront hamburgerInFront(vec4 b, float z_f, DepthRange range)
{
    Standardised s = standardised(b, range);
    InFront f = inFrontOf(threeAtoms(s, (z_f - s.mean) * s.perSigma));
    f.psi = asShare(f.psi);
    // Between the near end and the fragment, whatever rounding says; 0 for NaN.
    float moment = fma(f.psi, s.mean, f.moment / s.perSigma);
    f.moment = f.psi > 0.0f ? clamp(moment, f.psi * range.low, f.psi * z_f) : 0.0f;
    return f;
}

// E (v − p)(v − q)(v − r)
float cubicMean(Standardised s, float p, float q, float r)
{
    return s.skew - (p + q + r) - p * q * r;
}

// Hausdorff's moment problem: the least ψ of depths in [low, high], as rounding leaves it. Where one of the three atoms falls outside, the least is
// that of four: at the fragment, at either end, and one more.
float hausdorffLeast(vec4 b, float z_f, DepthRange range)
{
    Standardised s = standardised(b, range);
    float inside = clamp(z_f, range.low + 1e-6f, range.high); // below the first atom nothing can be in front
    float v = (inside - s.mean) * s.perSigma;
    float low = (range.low - s.mean) * s.perSigma;
    float high = (range.high - s.mean) * s.perSigma;

    ThreeAtoms a = threeAtoms(s, v);
    bool farInside = a.perFar < 0.0f ? low * a.perFar >= 1.0f : high * a.perFar >= 1.0f; // false for NaN
    bool three = farInside && a.near >= low && a.near <= high;

    // The fourth atom is where the mean of (x − low)(x − high)(x − v) comes from. There is none where that mean is 0 but for
    // rounding; nothing is taken for it then.
    float pull = cubicMean(s, low, high, v);
    float rounding = 1e-6f * (abs(s.skew) + high - low + abs(v) + abs(low * high * v));
    float moment = s.kurtosis - s.skew * (low + high + v) + low * high + v * (low + high);
    float u = abs(pull) > rounding ? clamp(moment / pull, low, high) : high;
    // In front of v: the lowest atom, or that and u. Both at once are the mean of the cubic that is 1 at them and 0 at v and
    // high, which holds where they meet.
    float lowest = cubicMean(s, u, v, high) / ((low - u) * (low - v) * (low - high));
    float quadratic = 1.0f / ((low - v) * (low - high));
    float both = quadratic * (fma(v, high, 1.0f) + pull * (v + high - low - u) / ((u - v) * (u - high)));
    float four = u < v ? both : lowest;

    // Never less than of depths anywhere.
    float anywhere = weightInFront(a);
    return z_f <= range.low ? 0.0f : three || !(four > anywhere) ? anywhere : four;
}

float hausdorffBound(vec4 b, float z_f, DepthRange range) { return asShare(hausdorffLeast(b, z_f, range)); }
