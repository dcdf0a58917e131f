// SPDX-License-Identifier: MIT
// Algorithm 2 of Peters and Klein 2015 for six moments: of all depths on the real line with the given means of z ... z⁶ the
// ones that put least in front of z_f have four atoms, one of them at z_f.
//
// Let P_j be the monic polynomials that are orthogonal under these depths, D_j = E P_j². The atom at u weighs
// 1 / Σ_j P_j(u)² / D_j, and the others are where K(u) = Σ_j P_j(z_f) P_j(u) / D_j = 0. In s with u = z_f + 1/s that is a
// cubic whose leading coefficient K(z_f) is at least 1: its roots are real and finite, an atom at infinity is s = 0, and
// s < 0 lies in front. For two moments the same gives Cantelli's inequality.

struct SixMoments {
    float b1, b2, b3, b4, b5, b6;
};

// (z − a_j) P_j = P_{j+1} + β_j P_{j−1}, β_j = D_j / D_{j−1}.
struct Recurrence {
    float a0, a1, a2;
    float d1, d2, d3;
};

// Depths lie in [−1, 1]; `least` is what the moment bias leaves of D1, D2 and D3 whatever the depths. Each a_j is a mean of
// depths, so that it lies among them whatever rounding says.
Recurrence recurrenceOf(SixMoments m, vec3 least)
{
    float d1 = max(fma(-m.b1, m.b1, m.b2), least.x);
    float l21 = fma(-m.b1, m.b2, m.b3) / d1;
    float l31 = fma(-m.b1, m.b3, m.b4) / d1;
    float d2 = max(fma(-l21, l21 * d1, fma(-m.b2, m.b2, m.b4)), least.y);
    float l32 = (fma(-m.b2, m.b3, m.b5) - l31 * l21 * d1) / d2;
    float d3 = max(fma(-l32, l32 * d2, fma(-l31, l31 * d1, fma(-m.b3, m.b3, m.b6))), least.z);
    Recurrence r;
    r.a0 = clamp(m.b1, -1.0f, 1.0f);
    r.a1 = clamp(l21 - m.b1, -1.0f, 1.0f);
    r.a2 = clamp(l32 - l21, -1.0f, 1.0f);
    r.d1 = d1;
    r.d2 = min(d2, d1); // β is at most 1
    r.d3 = min(d3, r.d2);
    return r;
}

// One of Newton's steps towards a root of s³ + a s² + b s + c, if it is a small one.
float polished(float s, float a, float b, float c)
{
    float change = fma(s, fma(s, s + a, b), c) / fma(s, fma(s, 3.0f, 2.0f * a), b);
    return abs(change) <= 0.1f * abs(s) ? s - change : s; // false for NaN
}

// The atom at z_f and the three others, at z_f + 1 / s.
struct FourAtoms {
    float weight;
    vec3 s;
    vec3 weights; // of the others, each by itself: all sum to 1 but for rounding
};

FourAtoms fourAtoms(Recurrence r, float z_f)
{
    float beta1 = r.d1;
    float beta2 = r.d2 / r.d1;
    // P_j(z_f + h) = p_j0 + p_j1 h + p_j2 h² + h³
    float t0 = z_f - r.a0;
    float t1 = z_f - r.a1;
    float t2 = z_f - r.a2;
    float p20 = fma(t0, t1, -beta1);
    float p21 = t0 + t1;
    float p30 = fma(t2, p20, -beta2 * t0);
    float p31 = fma(t2, p21, p20 - beta2);
    float p32 = p21 + t2;

    // s³ + a s² + b s + c: by cosines the root that is largest, which they know best; the others are those of what is left
    // of the polynomial without it.
    float k = 1.0f + t0 * t0 / r.d1 + p20 * p20 / r.d2 + p30 * p30 / r.d3;
    float a = (t0 / r.d1 + p20 * p21 / r.d2 + p30 * p31 / r.d3) / k;
    float b = (p20 / r.d2 + p30 * p32 / r.d3) / k;
    float c = p30 / r.d3 / k;
    float third = a / 3.0f;
    float q = max(fma(third, third, -b / 3.0f), 1e-30f);
    float root = sqrt(q);
    float cosine = (third * fma(third, third, -0.5f * b) + 0.5f * c) / (q * root);
    float angle = acos(clamp(cosine, -1.0f, 1.0f)) / 3.0f + (third < 0.0f ? 2.0943951f : 0.0f);
    float largest = polished(-2.0f * root * cos(angle) - third, a, b, c);
    float constant = -c / largest;
    float linear = (constant - b) / largest;
    float apart = sqrt(max(fma(linear, linear, -4.0f * constant), 0.0f));
    float second = -0.5f * (linear + (linear < 0.0f ? -apart : apart));

    FourAtoms atoms;
    atoms.weight = 1.0f / k;
    atoms.s = vec3(largest, second, second != 0.0f ? constant / second : 0.0f);
    for (int i = 0; i < 3; ++i) {
        float s = atoms.s[i];
        float p1 = fma(t0, s, 1.0f) * s * s;
        float p2 = fma(s, fma(s, p20, p21), 1.0f) * s;
        float p3 = fma(s, fma(s, fma(s, p30, p31), p32), 1.0f);
        float s3 = s * s * s;
        atoms.weights[i] = s3 * s3 / (s3 * s3 + p1 * p1 / r.d1 + p2 * p2 / r.d2 + p3 * p3 / r.d3);
    }
    return atoms;
}

// As rounding leaves it.
float sixMomentsLeast(SixMoments m, float z_f, vec3 least)
{
    FourAtoms atoms = fourAtoms(recurrenceOf(m, least), z_f);
    float inFront = 0.0f;
    float all = 0.0f;
    for (int i = 0; i < 3; ++i) {
        all += atoms.weights[i];
        inFront += atoms.s[i] < 0.0f ? atoms.weights[i] : 0.0f;
    }
    return (1.0f - atoms.weight) * inFront / max(all, 1e-30f);
}

float sixMomentsBound(SixMoments m, float z_f, vec3 least) { return asShare(sixMomentsLeast(m, z_f, least)); }
