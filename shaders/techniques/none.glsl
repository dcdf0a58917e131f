// SPDX-License-Identifier: MIT
// ψ of a scene in which nothing casts. No texture read of a map.
#include "resolve.glsl"

void main() { writeShadow(findReceiver(0.0), 0.0); }
