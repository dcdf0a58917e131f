// SPDX-License-Identifier: MIT
// sRGB encoding (IEC 61966-2-1) of one linear channel in [0, 1]. The power 1 / 2.4 is fitted by three square roots, within
// 0.00021 of it, a twentieth of an 8-bit step: they cost a fraction of a power on a software renderer.
float srgbFromLinear(float x)
{
    float s = sqrt(x);
    float q = sqrt(s);
    float curve = 0.55448447f * s + 0.90006551f * q - 0.48880215f * sqrt(q) + 0.03445218f;
    return x <= 0.0031308f ? 12.92f * x : curve;
}
