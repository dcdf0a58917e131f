// SPDX-License-Identifier: MIT
// The bound of two sines and cosines of depths in [0, 1] (Peters and Klein 2015, trigonometric moment shadow mapping; the
// paper has no algorithm). Depth z is the point w = exp(2πi z) of the unit circle, vec2(cos, sin), and t1 = E w, t2 = E w².
//
// The least mass in front of z_f is that of three atoms, one of them at z_f or at 1 and the others by the theory of
// canonical representations, or of four: at z_f, at 1 and two more. Of those there is a family of one parameter that runs
// from one set of three to the other. The mean of the depths weighed by p(z) = sin(πz) sin(π(z − z_f)), which is 0 at z_f
// and 1, knows of the two others alone: s0 = E p, s1 = E p w.

const float turn = 6.2831853f;

vec4 trigonometricOf(float z)
{
    vec2 w = vec2(cos(turn * z), sin(turn * z));
    return vec4(w.y, w.x, 2.0f * w.x * w.y, w.x * w.x - w.y * w.y);
}

vec2 onCircle(float z) { return vec2(cos(turn * z), sin(turn * z)); }
vec2 times(vec2 a, vec2 b) { return vec2(fma(a.x, b.x, -a.y * b.y), fma(a.x, b.y, a.y * b.x)); }
vec2 conjugate(vec2 a) { return vec2(a.x, -a.y); }

// The moments' Hermitian Toeplitz matrix as L D L*, with D0 = 1.
struct Toeplitz {
    vec2 t1, t2, l21;
    float d1, d2;
};

Toeplitz toeplitz(vec4 b, float leastPivot)
{
    Toeplitz t;
    t.t1 = vec2(b.y, b.x);
    t.t2 = vec2(b.w, b.z);
    t.d1 = max(1.0f - dot(t.t1, t.t1), leastPivot);
    t.l21 = (t.t1 - times(t.t2, conjugate(t.t1))) / t.d1;
    t.d2 = max(1.0f - dot(t.t2, t.t2) - t.d1 * dot(t.l21, t.l21), leastPivot);
    return t;
}

// What forward substitution makes of (1, w, w²), but for its 1.
struct Substituted {
    vec2 y1, y2;
};

Substituted substituted(Toeplitz t, vec2 w)
{
    Substituted s;
    s.y1 = w - t.t1;
    s.y2 = times(w, w) - t.t2 - times(t.l21, s.y1);
    return s;
}

// What an atom at w leaves for the two others that have the moments with it: 1 minus its weight.
float weightBeside(Substituted s, Toeplitz t)
{
    float all = dot(s.y1, s.y1) / t.d1 + dot(s.y2, s.y2) / t.d2;
    return all / (1.0f + all);
}

// The two atoms besides the one at w: z in [0, 1), the smaller first.
vec2 otherAtoms(Substituted s, Toeplitz t)
{
    vec2 c2 = s.y2 / t.d2;
    vec2 c1 = s.y1 / t.d1 - times(conjugate(t.l21), c2);
    vec2 c0 = vec2(1.0f, 0.0f) - times(conjugate(t.t1), c1) - times(conjugate(t.t2), c2);
    // Roots of c2* u² + c1* u + c0*, which lie on the circle: half their product's angle, and as far from it on both sides
    // as their sum says.
    vec2 product = times(conjugate(c0), c2); // times |c2|²
    float middle = 0.5f * atan(product.y, product.x);
    vec2 sum = -times(conjugate(c1), c2);
    float along = sum.x * cos(middle) + sum.y * sin(middle);
    float cosine = clamp(0.5f * along / max(dot(c2, c2), 1e-30f), -1.0f, 1.0f);
    float side = acos(cosine);
    float p = fract((middle - side) / turn);
    float q = fract((middle + side) / turn);
    return vec2(min(p, q), max(p, q));
}

// Of three atoms, one of them at w and not in front of z_f. The share that each of the others has is where their mean lies
// between them.
struct ThreeOnCircle {
    vec2 others;  // z, the smaller first
    float inFront;
};

ThreeOnCircle threeOnCircle(Toeplitz t, vec2 w, float z_f)
{
    Substituted s = substituted(t, w);
    float beside = weightBeside(s, t);
    ThreeOnCircle a;
    a.others = otherAtoms(s, t);
    vec2 e = onCircle(a.others.x);
    vec2 chord = e - onCircle(a.others.y);
    vec2 mean = t.t1 - (1.0f - beside) * w - beside * (e - chord);
    float first = clamp(dot(mean, chord) / max(dot(chord, chord), 1e-30f), 0.0f, beside);
    a.inFront = a.others.y < z_f ? beside : a.others.x < z_f ? first : 0.0f;
    return a;
}

// The weight of an atom at x in front of z_f where the fourth is the one behind z_f that goes with it.
float weightAt(float x, float z_f, float s0, vec2 s1)
{
    vec2 e = onCircle(x);
    vec2 across = s0 * e - s1;
    vec2 back = times(e, conjugate(s1)) - vec2(s0, 0.0f);
    vec2 f = times(across, conjugate(back)) / max(dot(back, back), 1e-30f); // the chord's other end
    vec2 chord = e - f;
    float a = dot(s1 - s0 * f, chord) / max(dot(chord, chord), 1e-30f);
    return a / (sin(0.5f * turn * x) * sin(0.5f * turn * (x - z_f)));
}

// b = E (sin 2πz, cos 2πz, sin 4πz, cos 4πz)
float trigonometricLeast(vec4 b, float depth, float leastPivot)
{
    float z_f = clamp(depth, 1e-4f, 1.0f - 1e-4f);
    Toeplitz t = toeplitz(b, leastPivot);
    ThreeOnCircle threeAtFragment = threeOnCircle(t, onCircle(z_f), z_f);
    ThreeOnCircle threeAtEnd = threeOnCircle(t, vec2(1.0f, 0.0f), z_f);
    vec2 atFragment = threeAtFragment.others;
    vec2 atEnd = threeAtEnd.others;
    float psi = min(threeAtFragment.inFront, threeAtEnd.inFront);

    vec2 u = vec2(cos(0.5f * turn * z_f), sin(0.5f * turn * z_f));
    float s0 = 0.5f * (u.x - dot(t.t1, u));
    vec2 s1 = 0.5f * (u.x * t.t1 - 0.5f * (times(t.t2, conjugate(u)) + u));
    float delta = s0 * s0 - dot(s1, s1);

    // One atom on either side of z_f: the least over the family, by golden section.
    float low = min(atFragment.x, atEnd.x);
    float high = max(atFragment.x, atEnd.x);
    bool between = delta < 0.0f && atFragment.x < z_f && atFragment.y > z_f && atEnd.x < z_f && atEnd.y > z_f;
    const float golden = 0.618034f;
    float x = high - golden * (high - low);
    float y = low + golden * (high - low);
    float f_x = weightAt(x, z_f, s0, s1);
    float f_y = weightAt(y, z_f, s0, s1);
    for (int i = 0; i < 12; ++i) {
        bool left = f_x < f_y;
        low = left ? low : x;
        high = left ? y : high;
        float inner = left ? high - golden * (high - low) : low + golden * (high - low);
        float f_inner = weightAt(inner, z_f, s0, s1);
        float kept = left ? x : y;
        float f_kept = left ? f_x : f_y;
        x = left ? inner : kept;
        f_x = left ? f_inner : f_kept;
        y = left ? kept : inner;
        f_y = left ? f_kept : f_inner;
    }
    float one = max(min(f_x, f_y), 0.0f);
    psi = between ? min(psi, one) : psi;

    // Both in front of it: they lie evenly about its half.
    float cosine = dot(s1, u) / s0;
    float half_z = acos(clamp(cosine, -1.0f, 1.0f)) / turn;
    float first = 0.5f * z_f - half_z;
    float second = 0.5f * z_f + half_z;
    vec2 e = onCircle(first);
    vec2 f = onCircle(second);
    vec2 chord = e - f;
    float a = dot(s1 - s0 * f, chord) / max(dot(chord, chord), 1e-30f);
    // p is the same at both.
    float p = sin(0.5f * turn * first) * sin(0.5f * turn * (first - z_f));
    float w_first = a / p;
    float w_second = (s0 - a) / p;
    vec2 rest = t.t1 - w_first * e - w_second * f;
    float left = 1.0f - w_first - w_second;
    vec2 apart = onCircle(z_f) - vec2(1.0f, 0.0f);
    float w_f = dot(rest - vec2(left, 0.0f), apart) / dot(apart, apart);
    float least = min(min(w_first, w_second), min(w_f, left - w_f));
    bool before = delta > 0.0f && s0 < 0.0f && abs(cosine) < 1.0f && first > 0.0f && least > -1e-6f;
    return before ? min(psi, s0 / p) : psi;
}

float trigonometricBound(vec4 b, float depth, float leastPivot) { return asShare(trigonometricLeast(b, depth, leastPivot)); }
