// SPDX-License-Identifier: MIT
// Blocker search, then a filter as wide as the penumbra; see renderer/techniques/pcss.cpp.
#include "shadow_lookup.glsl"
#include "lib/sampling.glsl"

bool disk = lightView.light.w != 0.0;

// i-th of n points of the square [−1, 1]² or, for disks, of the disk in it.
vec2 tap(int i, int n, vec2 shift)
{
    return disk ? vogelDisk(i, n, 6.2831853 * shift.x) : 2.0 * shifted(hammersley(i, n), shift) - 1.0;
}

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, true);
    vec2 shift = rotate != 0 ? pixelShift(vec2(r.pixel)) : vec2(0.0);
    vec2 halfLight = lightScale * lightView.light.xy;
    float f = lightView.sample_reference.z;
    vec2 texelsPerMetre = lightView.light.z / (2.0 * lightView.window.zw);
    // Never narrower than the texel itself: smaller filters only show its staircase.
    const vec2 smallest = vec2(1.0);

    vec2 search = max(penumbraHalfSize(halfLight, r.d, lightView.range.x, f, directional) * texelsPerMetre, smallest);
    int searched = r.known < 0.0 ? searchTaps : 0;
    float depths = 0.0;
    float blockers = 0.0;
    for (int i = 0; i < searched; ++i) {
        vec2 corner = floor(l.texel + search * tap(i, searchTaps, shift));
        float z = storedDepth(ivec2(corner));
        float b = blocks(l, z, corner + 0.5 - l.texel);
        depths += b * z;
        blockers += b;
    }
    float d_b = max(axialDepth(depths / max(blockers, 1.0)), lightView.range.x);
    vec2 penumbra = max(penumbraHalfSize(halfLight, r.d, d_b, f, directional) * texelsPerMetre, smallest);
    int filtered = blockers > 0.0 ? filterTaps : 0;
    float sum = 0.0;
    for (int i = 0; i < filtered; ++i) sum += blocksAt(l, l.texel + penumbra * tap(i, filterTaps, shift));
    writeShadow(r, sum / float(filterTaps));
}
