// SPDX-License-Identifier: MIT
// Point sets for filters: the same points everywhere, shifted and turned by one hash of the pixel.

// A set of n points is walked step by step from a start; a step costs a few instructions and no table. `share` is 1 / n.

// The lattice (i / n, i / golden ratio) on the torus: one axis in n even strata, the other nearly so, and as even in the
// plane as the Fibonacci lattice. Starting elsewhere shifts the whole set (Cranley and Patterson 1976). Points in [0, 1)².
vec2 latticeNext(vec2 point, float share)
{
    return fract(point + vec2(share, 0.61803399f));
}

// Vogel's spiral in the unit disk: the i-th of n points lies at radius √((i + ½) / n), a golden angle beyond the one
// before; even density for every n. `direction` is a unit vector, at first any.
vec2 spiralNext(vec2 direction)
{
    const float c = -0.73736888f; // cos and sin of 2.39996323 radians
    const float s = 0.67549029f;
    return vec2(c * direction.x - s * direction.y, s * direction.x + c * direction.y);
}

vec2 spiralPoint(vec2 direction, int i, float share)
{
    return direction * sqrt((float(i) + 0.5f) * share);
}

// Interleaved gradient noise (Jimenez 2014) in [0, 1): neighbours differ much, any 3x3 block is nearly uniform.
float gradientNoise(vec2 pixel)
{
    return fract(52.9829189f * fract(0.06711056f * pixel.x + 0.00583715f * pixel.y));
}

// Two numbers in [0, 1) for a pixel.
vec2 pixelShift(vec2 pixel)
{
    return vec2(gradientNoise(pixel), gradientNoise(vec2(pixel.y + 47.0f, pixel.x + 17.0f)));
}

