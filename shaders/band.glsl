// SPDX-License-Identifier: MIT
// Which texel of the written images an invocation makes; every pass over texels includes this and asks texelHere(). A dear
// pass runs in bands, each a dispatch of its own whose groups count from 0 again.
layout(local_size_x = 8, local_size_y = 8) in;

uniform uvec3 bandOrigin; // the band's first texel and layer

ivec3 texelHere() { return ivec3(gl_GlobalInvocationID + bandOrigin); }
