// SPDX-License-Identifier: MIT
// Point sets for filters: the same points everywhere, shifted and turned by one hash of the pixel.

// i-th of n points of the Hammersley set in [0, 1)²: each axis is split into n even strata (a (0, m, 2)-net for n = 2^m).
vec2 hammersley(int i, int n)
{
    uint bits = uint(i);
    bits = (bits << 16u) | (bits >> 16u);
    bits = ((bits & 0x55555555u) << 1u) | ((bits & 0xAAAAAAAAu) >> 1u);
    bits = ((bits & 0x33333333u) << 2u) | ((bits & 0xCCCCCCCCu) >> 2u);
    bits = ((bits & 0x0F0F0F0Fu) << 4u) | ((bits & 0xF0F0F0F0u) >> 4u);
    bits = ((bits & 0x00FF00FFu) << 8u) | ((bits & 0xFF00FF00u) >> 8u);
    return vec2((float(i) + 0.5f) / float(n), float(bits >> 8u) * (1.0f / 16777216.0f));
}

// Shifts a point of the unit square on the torus (Cranley and Patterson 1976); strata stay strata.
vec2 shifted(vec2 point, vec2 shift)
{
    return fract(point + shift);
}

// i-th of n points of Vogel's spiral in the unit disk, turned by `angle` [radians]: even density for every n.
vec2 vogelDisk(int i, int n, float angle)
{
    float r = sqrt((float(i) + 0.5f) / float(n));
    float phi = float(i) * 2.39996323f + angle;
    return vec2(r * cos(phi), r * sin(phi));
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

// The unit square onto the unit disk, area-preserving, with little distortion (Shirley and Chiu 1997). [0,1)² → |p| ≤ 1
vec2 concentricDisk(vec2 u)
{
    float a = 2.0f * u.x - 1.0f;
    float b = 2.0f * u.y - 1.0f;
    if (a == 0.0f && b == 0.0f) return vec2(0.0f);
    if (abs(a) > abs(b)) {
        float phi = 0.78539816f * (b / a);
        return vec2(a * cos(phi), a * sin(phi));
    }
    float phi = 1.57079633f - 0.78539816f * (a / b);
    return vec2(b * cos(phi), b * sin(phi));
}
