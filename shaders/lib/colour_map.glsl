// SPDX-License-Identifier: MIT
// Colours for numbers, sRGB encoded in [0, 1]. Needs lib/srgb.glsl.

// Viridis (van der Walt and Smith 2015, matplotlib): even in lightness, also for the colour-blind. t in [0, 1]. A fit of
// degree 6, by least squares, to ten of its colours, within 3.2 / 255 of them.
vec3 viridis(float t)
{
    float r = 0.26759f + t * (0.24441f + t * (-1.15333f + t * (-2.35686f + t * (3.27665f + t * (6.50162f - t * 5.78912f)))));
    float g = 0.00406f + t * (1.42852f + t * (-0.27071f + t * (-3.46537f + t * (9.51796f + t * (-9.49267f + t * 3.18401f)))));
    float b = 0.32956f + t * (1.51891f + t * (-1.26125f + t * (-13.94339f + t * (47.12248f + t * (-57.64625f + t * 24.02484f)))));
    return vec3(max(r, 0.0f), max(g, 0.0f), max(b, 0.0f));
}

float displayed(float linear) { return srgbFromLinear(min(max(linear, 0.0f), 1.0f)); }

// sRGB from OKLab (Ottosson 2020).
vec3 srgbFromOklab(float lightness, float a, float b)
{
    float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    l = l * l * l;
    m = m * m * m;
    s = s * s * s;
    return vec3(displayed(4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s),
                displayed(-1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s),
                displayed(-0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s));
}

// White at t = 0, red at 1, blue at −1. Each half is a straight line in OKLab, where distance is difference as seen, and
// both ends are equally dark and equally colourful: lightness 0.45, chroma 0.15, hues 27° and 258°.
vec3 diverging(float t)
{
    float far = abs(t);
    bool warm = t > 0.0f;
    return srgbFromOklab(1.0f - 0.55f * far, far * (warm ? 0.133651f : -0.031187f), far * (warm ? 0.068099f : -0.146722f));
}

float hueWave(float hue) { return min(max(abs(fract(hue) * 6.0f - 3.0f) - 1.0f, 0.0f), 1.0f); }

// For flags and indices: whole numbers get hues a golden ratio apart, every second one darker, so that neighbours differ
// much; 0 is nearly black.
vec3 flagColour(float value)
{
    float number = floor(value + 0.5f);
    float hue = fract(0.61803399f * number);
    float light = fract(0.5f * number) == 0.0f ? 1.0f : 0.7f;
    vec3 colour = vec3(0.3f + 0.65f * hueWave(hue), 0.3f + 0.65f * hueWave(hue + 0.66666667f),
                       0.3f + 0.65f * hueWave(hue + 0.33333333f));
    return number == 0.0f ? vec3(0.1f, 0.1f, 0.1f) : colour * light;
}
