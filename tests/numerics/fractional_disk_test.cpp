// SPDX-License-Identifier: MIT
// shaders/lib/fractional_disk.glsl against worked numbers and against geometry.
#include "tests/catch.h"
#include "tests/numerics/glsl_cpp.h"

#include <random>

TEST_CASE("equation 1: the disk's radius") {
    struct Row {
        double r, d1, d2, q;
    };
    for (const Row row : {Row{0.5, 4, 6, 0.75}, {0.5, 9, 1, 0.0555555555556}, {1, 2, 10, 5}}) {
        CHECK(f64::diskRadius(f64::vec2(row.r), row.d1, row.d2).x == Approx(row.q).epsilon(1e-11));
        CHECK(f32::diskRadius(f32::vec2(float(row.r)), float(row.d1), float(row.d2)).y == Approx(row.q).epsilon(1e-6));
    }
}

TEST_CASE("equation 2: the number of samples") {
    struct Row {
        double q;
        int counts[4]; // with a = 1, 2, 4, 8
    };
    for (const Row& row : {Row{0.5, {1, 1, 1, 1}},
                           {1, {4, 2, 1, 1}},
                           {2, {13, 7, 4, 2}},
                           {3, {29, 15, 8, 4}},
                           {5, {79, 40, 20, 10}},
                           {8, {202, 101, 51, 26}},
                           {16, {805, 403, 202, 101}}})
        for (int i = 0; i < 4; ++i) {
            const double a = 1 << i;
            CHECK(f64::sampleCount(f64::diskTexels(f64::vec2(row.q), true), a) == row.counts[i]);
            CHECK(f32::sampleCount(f32::diskTexels(f32::vec2(float(row.q)), true), float(a)) ==
                  static_cast<float>(row.counts[i]));
        }
    CHECK(f64::sampleCount(0, 2) == 1); // of a disk without a size, too
    CHECK(f64::diskTexels(f64::vec2(2, 3), false) == 24);
}

TEST_CASE("the inverse distance tells whether a boundary is within a radius, and the printed test does not") {
    constexpr double n = 5;
    const auto within = [&](double radius, bool printed) {
        int reached = -1; // the farthest texel that is softened
        for (int d = 0; d <= 10; ++d) {
            const double b = f64::inverseDistance(d, n);
            CHECK(b == (d <= n ? n + 1 - d : 0));
            if (printed ? f64::nearBoundaryAsPrinted(b, radius) : f64::nearBoundary(b, n, radius)) reached = d;
        }
        return reached;
    };
    CHECK(within(2, false) == 2);
    CHECK(within(5, false) == 5);
    CHECK(within(2, true) == 4);
    CHECK(within(5, true) == 1);
    CHECK_FALSE(f64::nearBoundary(0, n, 100));
}

TEST_CASE("the two-step test: an occluder counts if the receiver lies on its own disk") {
    struct Row {
        double r, receiver, occluder, l;
        bool counts;
    };
    for (const Row row : {Row{0.5, 10, 9.9, 0.05, false},
                          {0.5, 10, 9.9, 0.004, true},
                          {0.5, 10, 6, 0.3, true},
                          {0.5, 10, 6, 0.4, false},
                          {1, 10, 2, 3.9, true}})
        for (const double scale : {1.0, 37.5}) { // texels in a metre
            const double d2 = row.receiver - row.occluder;
            const f64::vec2 across(0, -row.l * scale);
            for (const bool round : {true, false})
                CHECK(f64::withinOwnDisk(across, f64::vec2(row.r), row.occluder, d2, scale, round) == row.counts);
            CHECK(f32::withinOwnDisk(f32::vec2(across), f32::vec2(float(row.r)), float(row.occluder), float(d2),
                                     float(scale), true) == row.counts);
        }
    // A corner lies in the square, not in the disk.
    CHECK(f64::withinOwnDisk(f64::vec2(0.9, 0.9), f64::vec2(1), 1, 1, 1, false));
    CHECK_FALSE(f64::withinOwnDisk(f64::vec2(0.9, 0.9), f64::vec2(1), 1, 1, 1, true));
}

// The light's point s sees the receiver P past an occluder at depth d1 where the ray between them crosses that depth;
// the disk's point P + o, o = −s d2 / d1, is on the ray through the light's centre and the same place.
TEST_CASE("a point of the light is hidden exactly where its point of the disk is") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const double r = 0.5 + 0.4 * u(random), d1 = 3 + 2 * u(random), d2 = 2.5 + 2 * u(random);
        const double receiver = 3 * u(random), share = u(random); // of the light's radius
        const double crossing = receiver + (share * r - receiver) * d2 / (d1 + d2);
        const double onDisk = receiver + share * f64::diskRadius(f64::vec2(r), d1, d2).x;
        CHECK(onDisk * d1 / (d1 + d2) == Approx(crossing).margin(1e-12));
    }
}

TEST_CASE("the four regions") {
    CHECK(f64::regionOf(false, false) == f64::regionLit);
    CHECK(f64::regionOf(false, true) == f64::regionOuter);
    CHECK(f64::regionOf(true, true) == f64::regionInner);
    CHECK(f64::regionOf(true, false) == f64::regionUmbra);
}
