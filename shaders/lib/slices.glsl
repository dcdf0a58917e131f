// SPDX-License-Identifier: MIT
// The depth range in `count` slices (Lauritzen and McCool 2008): where depth is cut off outside a slice, what lies before it
// or behind it adds nothing to its variance. A slice reaches `overlap` of its width into those beside it.

float inSlice(float z, int i, float count, float overlap)
{
    float x = (z * count - float(i) + overlap) / (1.0f + 2.0f * overlap);
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

// Of the slices 2n and 2n + 1 on layer n: the place of z in each, and its square.
vec4 slicesOf(float z, int layer, float count, float overlap)
{
    float a = inSlice(z, 2 * layer, count, overlap);
    float b = inSlice(z, 2 * layer + 1, count, overlap);
    return vec4(a, a * a, b, b * b);
}
