// SPDX-License-Identifier: MIT
// shaders/lib against geometry done the long way, closed forms and definitions.
#include "tests/catch.h"
#include "tests/numerics/glsl_cpp.h"

#include <random>

namespace {

using glm::dvec2;
using glm::dvec3;

// Where the ray from the light's point (s, 0) through P meets the plane z = −f.
dvec2 throughPlane(dvec3 p, dvec2 s, double f) {
    const dvec3 from(s, 0), direction = p - from;
    const dvec3 hit = from + direction * (-f / direction.z);
    return {hit.x, hit.y};
}

} // namespace

TEST_CASE("a point's place on the reference plane is where its ray from the light meets it") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(-3, 3), depth(0.1, 20);
    for (int i = 0; i < 1000; ++i) {
        const dvec3 p(u(random), u(random), -depth(random));
        const dvec2 s(u(random), u(random));
        const double f = depth(random);
        const dvec2 area = f64::referenceFromLight(p, s, f, false);
        CHECK(glm::distance(area, throughPlane(p, s, f)) == Approx(0).margin(1e-9));
        // Directional: along the direction (s, 1) towards the light.
        const dvec3 onPlane = p + dvec3(s, 1.0) * (-f - p.z);
        CHECK(glm::distance(f64::referenceFromLight(p, s, f, true), dvec2(onPlane.x, onPlane.y)) ==
              Approx(0).margin(1e-9));
        const dvec2 single = dvec2(f32::referenceFromLight(glm::vec3(p), glm::vec2(s), float(f), false));
        CHECK(glm::distance(single, area) <= 1e-5 * (1 + glm::length(area)));
    }
}

TEST_CASE("the step from a pixel to the next is where its ray meets the plane, on the reference plane too") {
    using glm::dvec2;
    using glm::dvec3;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int round = 0; round < 200; ++round) {
        const bool directional = round % 2 == 0, parallel = round % 3 == 0;
        const dvec3 eye(unit(random), unit(random), 6),
            n = glm::normalize(dvec3(0.3 * unit(random), 0.3 * unit(random), 1));
        const dvec3 ray(parallel ? 0.0 : 0.3 * unit(random), 0.1, -1);
        const dvec3 eyeStep = parallel ? dvec3(0.01, 0, 0.002) : dvec3(0);
        const dvec3 rayStep = parallel ? dvec3(0) : dvec3(0.001, 0.0002, 0);
        const double depth = 9;
        const dvec3 p = eye + depth * ray;
        const dvec2 s(0.2 * unit(random), 0.2 * unit(random));
        const double f = 12;
        // Half a pixel to either side.
        const auto beside = [&](double h) {
            const dvec3 from = eye + h * eyeStep, along = ray + h * rayStep;
            return from + along * (glm::dot(n, p - from) / glm::dot(n, along));
        };
        const dvec3 step = f64::stepAlongPlane(eyeStep, rayStep, depth, ray, n);
        const dvec3 difference = beside(0.5) - beside(-0.5);
        CAPTURE(round);
        CHECK(glm::length(step - difference) < 1e-4 * glm::length(difference));
        const dvec2 place = f64::referenceFromLight(beside(0.5), s, f, directional) -
                            f64::referenceFromLight(beside(-0.5), s, f, directional);
        CHECK(glm::length(f64::referenceStep(p, step, s, f, directional) - place) < 1e-3 * glm::length(place) + 1e-9);
    }
}

TEST_CASE("penumbra and search region have the golden sizes") {
    // algorithms of PCSS on the near plane n: search r (z_r − n) / (z_r W), filter q n / (z_r W), both in uv. On a
    // reference plane f the window is W f / n wide, so uv = size / (W f / n).
    struct Row {
        double r, n, fov, z_r, z_b, searchUv, widthOnReceiver, filterUv;
    };
    for (const Row& row :
         {Row{0.5, 1, 60, 10, 4, 0.389711431703, 0.75, 0.0649519052838},
          Row{0.5, 1, 60, 10, 9, 0.389711431703, 0.0555555555556, 0.00481125224325},
          Row{0.25, 0.1, 90, 5, 2.5, 1.225, 0.25, 0.025}, Row{1, 2, 45, 20, 5, 0.543198051534, 3, 0.181066017178}}) {
        const double f = 7, window = 2 * std::tan(glm::radians(row.fov / 2)) * f;
        CHECK(f64::penumbraHalfSize(dvec2(row.r), row.z_r, row.n, f, false).x / window ==
              Approx(row.searchUv).epsilon(1e-9));
        const double filter = f64::penumbraHalfSize(dvec2(row.r), row.z_r, row.z_b, f, false).x;
        CHECK(filter / window == Approx(row.filterUv).epsilon(1e-9));
        CHECK(filter * row.z_r / f == Approx(row.widthOnReceiver).epsilon(1e-9));
    }
    // The sun, 10 m below what casts.
    const double sun = std::tan(glm::radians(0.2665));
    CHECK(f64::penumbraHalfSize(dvec2(sun), 30.0, 20.0, 7.0, true).x == Approx(0.046513359999).epsilon(1e-9));
    // Nothing behind the receiver widens it.
    CHECK(f64::penumbraHalfSize(dvec2(1), 5.0, 6.0, 7.0, false).x == 0);
}

TEST_CASE("the box filter of the penumbra's size is the exact share of a half plane's square light") {
    // Edge at x = 0, height h over the receiver, light of half width a at height H: V = (a + x (H − h) / h) / 2a.
    const double a = 0.5, H = 10, h = 6;
    for (double x = -0.9; x < 0.9; x += 0.05) {
        const double d_r = H, d_b = H - h, f = 3;
        const double half = f64::penumbraHalfSize(dvec2(a), d_r, d_b, f, false).x, place = x * f / d_r;
        const double filtered =
            std::clamp((place + half) / (2 * half), 0.0, 1.0); // lit where the filter reaches beyond 0
        CHECK(filtered == Approx(std::clamp((a + x * (H - h) / h) / (2 * a), 0.0, 1.0)).margin(1e-12));
    }
}

TEST_CASE("the receiver's plane has the depth that a ray to it measures, at any tilt") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> u(-1, 1), depth(1, 20);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const bool directional = i % 2 == 0;
        const dvec3 p(4 * u(random), 4 * u(random), -depth(random));
        const dvec2 s(u(random), u(random));
        const double f = depth(random), farthest = 1000;
        const dvec3 n = glm::normalize(dvec3(u(random), u(random), std::abs(u(random)) + 0.05));
        const dvec3 light(s, directional ? 1.0 : 0.0);
        const double facing = directional ? glm::dot(n, light) : glm::dot(n, p - light);
        if (directional ? facing < 0.02 : facing > -0.02) continue;
        const dvec2 delta(u(random), u(random));
        const double d_r = -p.z;
        const dvec2 g = f64::planeGradient(n, facing, d_r, f, directional);
        const double depthThere = f64::planeDepth(g, delta, d_r, farthest, directional);

        const dvec2 place = f64::referenceFromLight(p, s, f, directional) + delta;
        const dvec3 from = directional ? dvec3(place, -f) : dvec3(s, 0);
        const dvec3 along = directional ? dvec3(s, 1.0) : dvec3(place, -f) - from;
        const double t = glm::dot(n, p - from) / glm::dot(n, along);
        const double expected = -(from + t * along).z;
        CAPTURE(directional, p.x, p.y, p.z, n.x, n.y, n.z, delta.x, delta.y);
        if (!directional && t <= 0) {
            CHECK(depthThere == farthest); // the ray leaves the plane behind
        } else {
            ++met;
            CHECK(depthThere == Approx(std::min(expected, farthest)).epsilon(1e-8));
            const double single =
                f32::planeDepth(f32::planeGradient(glm::vec3(n), float(facing), float(d_r), float(f), directional),
                                glm::vec2(delta), float(d_r), float(farthest), directional);
            if (depthThere > 0.5 && depthThere < 50) CHECK(single == Approx(depthThere).epsilon(2e-4));
        }
    }
    CHECK(met > 1000);
}

TEST_CASE("octahedral normals come back") {
    std::mt19937 random(3);
    std::normal_distribution<double> gauss;
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        dvec3 v = glm::normalize(dvec3(gauss(random), gauss(random), gauss(random)));
        if (i % 7 == 0) v = glm::normalize(dvec3(i % 14 ? 0 : v.x, v.y, i % 21 ? v.z : 0) + 1e-12);
        const dvec2 p = f64::octahedralFromDirection(v * 3.0);
        CHECK((std::abs(p.x) <= 1 + 1e-12 && std::abs(p.y) <= 1 + 1e-12));
        worst = std::max(worst, glm::distance(f64::unitFromOctahedral(p), v));
        // As RGBA16_SNORM stores it: within a 25000th of a radian.
        const dvec2 stored = glm::round(p * 32767.0) / 32767.0;
        CHECK(glm::distance(f64::unitFromOctahedral(stored), v) < 8e-5);
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("filter points are even: strata, density and range") {
    for (const int n : {1, 4, 16, 64}) {
        std::vector<int> x(static_cast<size_t>(n)), y(static_cast<size_t>(n));
        glm::vec2 point(0.3f, 0.8f);
        for (int i = 0; i < n; ++i) {
            point = f32::latticeNext(point, 1.0f / static_cast<float>(n));
            REQUIRE((point.x >= 0 && point.x < 1 && point.y >= 0 && point.y < 1));
            ++x[static_cast<size_t>(std::fmod(point.x + 1.7f + 0.5f / static_cast<float>(n), 1.0f) *
                                    static_cast<float>(n))];
            ++y[static_cast<size_t>(point.y * static_cast<float>(n))];
        }
        CHECK(std::all_of(x.begin(), x.end(), [](int c) { return c == 1; })); // one a stratum, wherever the set starts
        CHECK(*std::max_element(y.begin(), y.end()) <= 2);                    // and at most two on the other axis
    }
    // The worst error of a box share over boxes from the origin: of the order of log n / n, far below 1 / √n.
    for (const int n : {16, 64}) {
        std::vector<glm::dvec2> points;
        glm::dvec2 point(0);
        for (int i = 0; i < n; ++i) points.push_back(point = f64::latticeNext(point, 1.0 / n));
        double worst = 0;
        for (double u = 0.05; u < 1; u += 0.05)
            for (double v = 0.05; v < 1; v += 0.05) {
                const auto inside =
                    std::count_if(points.begin(), points.end(), [&](glm::dvec2 p) { return p.x < u && p.y < v; });
                worst = std::max(worst, std::abs(static_cast<double>(inside) / n - u * v));
            }
        CAPTURE(n, worst);
        CHECK(worst < (n == 16 ? 0.12 : 0.04));
    }
    // Vogel's spiral: as many points within radius r as r² says, and turned by the golden angle.
    for (const int n : {1, 5, 16, 64}) {
        glm::dvec2 direction(1, 0);
        for (int i = 0; i < n; ++i) {
            const glm::dvec2 next = f64::spiralNext(direction);
            CHECK(std::acos(glm::dot(direction, next)) == Approx(2.39996323).epsilon(1e-5));
            CHECK(glm::length(f64::spiralPoint(next, i, 1.0 / n)) == Approx(std::sqrt((i + 0.5) / n)).epsilon(1e-5));
            direction = next;
        }
        // After many turns the float copy is still on the circle.
        glm::vec2 single(1, 0);
        for (int i = 0; i < 64; ++i) single = f32::spiralNext(single);
        CHECK(glm::length(single) == Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("the sRGB curve is within a twentieth of an 8-bit step, from black to white") {
    double worst = 0;
    for (int i = 0; i <= 100000; ++i) {
        const double x = i / 100000.0;
        const double exact = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        const double encoded = f32::srgbFromLinear(static_cast<float>(x));
        worst = std::max(worst, std::abs(encoded - exact));
    }
    CHECK(worst < 1.0 / 255 / 18);
    CHECK(f32::srgbFromLinear(0.0f) == 0);
    CHECK(f32::srgbFromLinear(1.0f) == Approx(1).margin(2.1e-4));
}

namespace {

// OKLab from sRGB in [0, 1] (Ottosson 2020), the other way round than shaders/lib/colour_map.glsl.
dvec3 oklab(dvec3 encoded) {
    dvec3 linear;
    for (int c = 0; c < 3; ++c)
        linear[c] = encoded[c] <= 0.04045 ? encoded[c] / 12.92 : std::pow((encoded[c] + 0.055) / 1.055, 2.4);
    const double l = std::cbrt(0.4122214708 * linear.r + 0.5363325363 * linear.g + 0.0514459929 * linear.b);
    const double m = std::cbrt(0.2119034982 * linear.r + 0.6806995451 * linear.g + 0.1073969566 * linear.b);
    const double s = std::cbrt(0.0883024619 * linear.r + 0.2817188376 * linear.g + 0.6299787005 * linear.b);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

} // namespace

TEST_CASE("viridis has its published colours and grows evenly lighter") {
    constexpr int published[10][3] = {{68, 1, 84},    {72, 40, 120},  {62, 73, 137},  {49, 104, 142}, {38, 130, 142},
                                      {31, 158, 137}, {53, 183, 121}, {110, 206, 88}, {181, 222, 43}, {253, 231, 37}};
    for (int i = 0; i < 10; ++i)
        for (int c = 0; c < 3; ++c) {
            CHECK(255 * f64::viridis(i / 9.0)[c] == Approx(published[i][c]).margin(3.5));
            CHECK(f32::viridis(static_cast<float>(i) / 9)[c] == Approx(f64::viridis(i / 9.0)[c]).margin(1e-5));
        }
    for (int i = 0; i < 256; ++i) {
        const double step = oklab(f64::viridis((i + 1) / 256.0)).x - oklab(f64::viridis(i / 256.0)).x;
        CHECK(step > 0.0010); // a mean of 0.0026
        CHECK(step < 0.0045);
    }
}

TEST_CASE("the diverging map is white at zero, even in what is seen, and as strong on both sides") {
    for (int c = 0; c < 3; ++c) CHECK(f64::diverging(0.0)[c] == Approx(1).margin(1e-3));
    const dvec3 white = oklab({1, 1, 1});
    const double whole = glm::distance(oklab(f64::diverging(1.0)), white);
    CHECK(whole > 0.5);
    for (int i = 0; i <= 64; ++i) {
        const double t = i / 64.0;
        for (const double side : {-1.0, 1.0})
            CHECK(glm::distance(oklab(f64::diverging(side * t)), white) == Approx(t * whole).margin(0.005));
        CHECK(oklab(f64::diverging(t)).x == Approx(oklab(f64::diverging(-t)).x).margin(0.005));
    }
    CHECK(f64::diverging(1.0).r > f64::diverging(1.0).b);
    CHECK(f64::diverging(-1.0).b > f64::diverging(-1.0).r);
}

TEST_CASE("flags that are near in number are far in colour") {
    for (int i = 0; i < 24; ++i)
        for (int k = i + 1; k < i + 6; ++k)
            CHECK(glm::distance(oklab(f64::flagColour(double(i))), oklab(f64::flagColour(double(k)))) > 0.08);
}
