// SPDX-License-Identifier: MIT
// Algorithm 3 on windows of a summed-area table; see renderer/techniques/msm_soft.cpp.
#include "soft_moments.glsl"

InFront blockingIn(vec4 b, float z_f) { return hamburgerInFront(b, z_f, mappedRange()); }
