// SPDX-License-Identifier: MIT
// shaders/lib as C++: the very text that the GPU runs, once in float (does the arithmetic survive?) and once in double
// (is the formula right?), as namespaces f32 and f64. Literals keep their suffix f in both, so that both copies share
// the constants that the GPU has and their difference is the rounding of the arithmetic alone.
//
// Redefining a keyword is outside the letter of the standard; every header is included before, and it is undone below.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace {

namespace builtins {
template <class S, class T>
concept Foreign = std::is_arithmetic_v<S> && !std::same_as<S, T>;
template <class A, class B>
concept Numbers = std::is_arithmetic_v<A> && std::is_arithmetic_v<B>;

// GLSL lets a float literal meet any number; these bridge the double copy.
template <int N, class T, Foreign<T> S> auto operator*(glm::vec<N, T> v, S s) { return v * T(s); }
template <int N, class T, Foreign<T> S> auto operator*(S s, glm::vec<N, T> v) { return T(s) * v; }
template <int N, class T, Foreign<T> S> auto operator+(glm::vec<N, T> v, S s) { return v + T(s); }
template <int N, class T, Foreign<T> S> auto operator-(glm::vec<N, T> v, S s) { return v - T(s); }
template <class A, class B>
requires Numbers<A, B>
auto max(A a, B b) {
    using T = std::common_type_t<A, B>;
    return T(a) < T(b) ? T(b) : T(a);
}
template <class A, class B>
requires Numbers<A, B>
auto min(A a, B b) {
    using T = std::common_type_t<A, B>;
    return T(b) < T(a) ? T(b) : T(a);
}
template <class A, class B, class C>
requires Numbers<A, B> && std::is_arithmetic_v<C>
auto clamp(A a, B low, C high) { return min(max(a, low), high); }
using glm::abs;
using glm::acos;
using glm::atan;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::fract;
using glm::inversesqrt;
using glm::length;
using glm::normalize;
using glm::sin;
using glm::sqrt;
using uint = uint32_t;
} // namespace builtins

// GLSL's fma() may be one rounding or two. Of a function that has it there are both.
namespace unfused {
template <class A, class B, class C> auto fma(A a, B b, C c) {
    using T = std::common_type_t<A, B, C>;
    return T(a) * T(b) + T(c);
}
} // namespace unfused
namespace fused {
template <class A, class B, class C> auto fma(A a, B b, C c) {
    using T = std::common_type_t<A, B, C>;
    return std::fma(T(a), T(b), T(c));
}
} // namespace fused

namespace f32 {
using namespace builtins;
using vec2 = glm::vec<2, float>;
using vec3 = glm::vec<3, float>;
using vec4 = glm::vec<4, float>;
#include "shaders/lib/fractional_disk.glsl"
#include "shaders/lib/light_space.glsl"
#include "shaders/lib/octahedral.glsl"
#include "shaders/lib/posing.glsl"
#include "shaders/lib/sampling.glsl"
#include "shaders/lib/srgb.glsl"
#include "shaders/lib/temporal.glsl"
#include "shaders/lib/colour_map.glsl"
using namespace unfused;
#include "shaders/lib/moments.glsl"
#include "shaders/lib/convolution.glsl"
#include "shaders/lib/moments_six.glsl"
#include "shaders/lib/moments_trigonometric.glsl"
#include "shaders/lib/slices.glsl"
} // namespace f32

namespace f32fused {
using namespace builtins;
using namespace fused;
using vec2 = glm::vec<2, float>;
using vec3 = glm::vec<3, float>;
using vec4 = glm::vec<4, float>;
#include "shaders/lib/moments.glsl"
#include "shaders/lib/convolution.glsl"
#include "shaders/lib/moments_six.glsl"
#include "shaders/lib/moments_trigonometric.glsl"
#include "shaders/lib/slices.glsl"
} // namespace f32fused

#define float double
namespace f64 {
using namespace builtins;
using vec2 = glm::vec<2, double>;
using vec3 = glm::vec<3, double>;
using vec4 = glm::vec<4, double>;
#include "shaders/lib/fractional_disk.glsl"
#include "shaders/lib/light_space.glsl"
#include "shaders/lib/octahedral.glsl"
#include "shaders/lib/posing.glsl"
#include "shaders/lib/sampling.glsl"
#include "shaders/lib/srgb.glsl"
#include "shaders/lib/temporal.glsl"
#include "shaders/lib/colour_map.glsl"
using namespace fused;
#include "shaders/lib/moments.glsl"
#include "shaders/lib/convolution.glsl"
#include "shaders/lib/moments_six.glsl"
#include "shaders/lib/moments_trigonometric.glsl"
#include "shaders/lib/slices.glsl"
} // namespace f64
#undef float

} // namespace

#pragma GCC diagnostic pop
