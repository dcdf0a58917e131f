// SPDX-License-Identifier: MIT
// Blocker search, then a filter as wide as the penumbra; see renderer/techniques/pcss.cpp.
#include "percentage_closer.glsl"

void main()
{
    Receiver r = findReceiver(normalOffset);
    Lookup l = makeLookup(r, depthBias, slopeBias, receiverPlane != 0, true);
    vec2 shift = rotate != 0 ? pixelShift(vec2(r.pixel)) : vec2(0.0);
    vec2 halfLight = lightScale * lightView.light.xy;
    const vec2 s = vec2(0.0); // the map is seen from the centre

    int searched = r.known < 0.0 ? searchTaps : 0;
    float d_b = meanBlocker(r, l, halfLight, s, shift, searched, 1.0 / float(searchTaps), SEARCH == SEARCH_CENTRED);
    int filtered = d_b > noBlocker ? filterTaps : 0;
    writeShadow(r, filteredShadow(r, l, halfLight, s, d_b, shift, filtered, 1.0 / float(filterTaps)));
}
