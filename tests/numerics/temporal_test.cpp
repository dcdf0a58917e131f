// SPDX-License-Identifier: MIT
// shaders/lib/temporal.glsl against the papers' own numbers and against counting the long way.
#include "tests/catch.h"
#include "tests/numerics/glsl_cpp.h"

#include <cmath>
#include <limits>
#include <random>

namespace {

constexpr int tableTests[] = {1, 0, 1, 1, 1, 0, 1}; // τ_1 .. τ_7

} // namespace

TEST_CASE("table 1 of the paper comes out, for n = 2 to 7") {
    // ψ̂_n, its variance and standard error, as printed and to more digits.
    constexpr double printed[7][3] = {{1.00, 0, 0},       {0.50, 0.25, 0.50}, {0.67, 0.11, 0.33}, {0.75, 0.06, 0.25},
                                      {0.80, 0.04, 0.20}, {0.67, 0.04, 0.21}, {0.71, 0.03, 0.18}};
    constexpr double exact[7][2] = {{1, 1},
                                    {0.5, 0.5},
                                    {2 / 3.0, 1 / 3.0},
                                    {0.75, 0.25},
                                    {0.8, 0.2},
                                    {2 / 3.0, 0.2108185107},
                                    {5 / 7.0, 0.1844277784}};
    constexpr double cautious[7] = {0.2357022604, 0.2236067977, 0.2,         0.1781741613,
                                    0.1597191412, 0.1613743061, 0.1490711985};
    f64::History h{};
    f32::History single{};
    for (int i = 0; i < 7; ++i) {
        h = f64::withSample(h, tableTests[i], 1e9);
        single = f32::withSample(single, static_cast<float>(tableTests[i]), 1e9f);
        CAPTURE(i + 1);
        CHECK(f64::estimated(h) == Approx(printed[i][0]).margin(0.005));
        CHECK(f64::estimated(h) == Approx(exact[i][0]).epsilon(1e-9));
        CHECK(f64::standardError(h) == Approx(exact[i][1]).epsilon(1e-9));
        CHECK(f64::cautiousError(h) == Approx(cautious[i]).epsilon(1e-9));
        if (i > 0) { // of one test the table says 0; it is 0/0
            CHECK(f64::standardError(h) == Approx(printed[i][2]).margin(0.005));
            CHECK(f64::standardError(h) * f64::standardError(h) == Approx(printed[i][1]).margin(0.005));
        }
        CHECK(f32::estimated(single) == Approx(exact[i][0]).epsilon(1e-6));
        CHECK(f32::standardError(single) == Approx(exact[i][1]).epsilon(1e-5));
    }
}

TEST_CASE("thresholds are met after as many samples as the binomial law says") {
    // The first n at which √(ψ (1 − ψ) / (n − 1)) < t.
    struct Row {
        double psi, t;
        int n;
    };
    for (const Row row : {Row{0.5, 1 / 5.0, 8}, {0.5, 1 / 50.0, 627}, {0.25, 1 / 16.0, 50}, {0.1, 1 / 32.0, 94}}) {
        int n = 2;
        while (f64::standardError({row.psi * n, double(n)}) >= row.t) ++n;
        CHECK(n == row.n);
    }
}

TEST_CASE("the blend between two errors is the thesis's, and never leaves [0, 1]") {
    CHECK(f64::sampledShare(0.0625, 0.03125, 0.125) == Approx(2 / 3.0));
    CHECK(f64::sampledShare(0.1, 0.02, 0.2) == Approx(0.5555555556));
    CHECK(f64::sampledShare(0.25, 0.02, 0.2) == 0);
    CHECK(f64::sampledShare(0.01, 0.02, 0.2) == 1);
    // Both alike: the paper's threshold. At it, samples.
    CHECK(f64::sampledShare(0.02, 0.02, 0.02) == 1);
    CHECK(f64::sampledShare(0.0201, 0.02, 0.02) == 0);
    CHECK(f32::sampledShare(0, 0, 0) == 1);
}

TEST_CASE("blocker depths follow equation 7") {
    double mean = 5;
    constexpr double depths[] = {6, 4.5, 7}, expected[] = {5.05555555556, 5.02631578947, 5.125};
    for (int i = 0; i < 3; ++i) {
        mean = f64::withBlocker(mean, depths[i], i + 2, 16);
        CHECK(mean == Approx(expected[i]).epsilon(1e-10));
    }
}

TEST_CASE("a history counts exactly to its limit and then stands still") {
    f32::History h{};
    int shadowed = 0;
    std::mt19937 random(5);
    for (int i = 1; i <= 100000; ++i) {
        const int tau = random() % 10 < 3 ? 1 : 0;
        shadowed += tau;
        h = f32::withSample(h, static_cast<float>(tau), 16777216.0f);
        if (i % 9999 == 0) REQUIRE((h.rho == static_cast<float>(shadowed) && h.n == static_cast<float>(i)));
    }
    const f32::History full{1500, 2048};
    const f32::History after = f32::withSample(full, 1, 2048);
    CHECK((after.rho == 1500 && after.n == 2048));
}

TEST_CASE("fewer samples have the same mean, and no history is below none") {
    for (const double n : {1.0, 5.0, 77.5, 4096.0})
        for (const double psi : {0.0, 0.3, 1.0}) {
            const f64::History h{psi * n, n};
            for (const double delta : {0.5, 2.0, 10.0}) {
                const f64::History fewer = f64::decremented(h, delta);
                CHECK(fewer.n == Approx(std::max(n - delta, 0.0)).margin(1e-12));
                CHECK(fewer.rho == Approx(psi * fewer.n).margin(1e-12));
            }
            CHECK(f64::limited(h, 8).n == std::min(n, 8.0));
        }
    CHECK(f64::limited({0, 0}, 0).n == 0);
}

TEST_CASE("what is not a history is never taken for one, nor a NaN for a surface") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    CHECK(f32::sound({3, 4}));
    CHECK(f32::sound({0, 1}));
    for (const f32::History& h : {f32::History{0, 0},
                                  {nan, 4},
                                  {3, nan},
                                  {nan, nan},
                                  {infinity, infinity},
                                  {1, infinity},
                                  {5, 4},
                                  {-1, 4},
                                  {1, -4}})
        CHECK_FALSE(f32::sound(h));
    for (const bool relative : {false, true})
        for (const float bad : {nan, infinity, -infinity}) {
            CHECK_FALSE(f32::sameSurface(1, bad, 1, relative));
            CHECK_FALSE(f32::sameSurface(bad, 1, 1, relative));
        }
    CHECK_FALSE(f32::sameSurface(1, 1, 0, true)); // ε = 0 is met by nothing
}

TEST_CASE("surfaces are told apart absolutely or relatively, as in the papers") {
    struct Row {
        double now, before;
        bool absolutely, relatively; // ε = 0.001
    };
    for (const Row row : {Row{0.5, 0.5008, true, false},
                          {0.5, 0.502, false, false},
                          {100, 100.05, false, true},
                          {100, 100.5, false, false},
                          {0.0005, 0.0006, true, false}}) {
        CHECK(f64::sameSurface(row.now, row.before, 0.001, false) == row.absolutely);
        CHECK(f64::sameSurface(row.now, row.before, 0.001, true) == row.relatively);
    }
}

TEST_CASE("a neighbour is of the same surface if it lies where its ray meets the surface's plane") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(u(random), u(random), u(random)));
        const glm::dvec3 centre(u(random), u(random), -1),
            ray(centre.x + 0.1 * u(random), centre.y + 0.1 * u(random), -1);
        const double from = glm::dot(n, centre), along = glm::dot(n, ray), d = 3 + u(random), exact = d * from / along;
        for (const bool relative : {true, false}) {
            const double epsilon = 0.01, step = relative ? epsilon * exact : epsilon;
            const double tilt = along / from;
            const auto same = [&](double stored) { return f64::samePlane(d, tilt, stored, epsilon, relative); };
            if (exact > 0.51 * d && exact < 1.99 * d) {
                CHECK(same(exact));
                CHECK(same(exact + 0.98 * step));
                CHECK_FALSE(same(exact + 1.02 * step));
                CHECK_FALSE(same(exact - 1.02 * step));
                CHECK(f32::samePlane(float(d), float(tilt), float(exact), float(epsilon), relative));
                ++met;
            } else if (!(exact > 0.49 * d && exact < 2.01 * d)) {
                CHECK(same(d));
            }
        }
    }
    CHECK(met > 2000);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, infinity, 0.0f}) CHECK_FALSE(f32::samePlane(3, 1, bad, 0.5f, true));
    for (const float edgeOn : {nan, infinity, 0.0f}) CHECK(f32::samePlane(3, edgeOn, 3, 0.5f, true));
}

TEST_CASE("a shadow moves along the surface it falls on") {
    const glm::dvec3 across(0.3, 0, 0), towards = glm::normalize(glm::dvec3(1, 3, 0.5));
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.2, 1, -0.1));
    const glm::dvec3 moved = f64::alongSurface(across, towards, n);
    CHECK(glm::dot(moved, n) == Approx(0).margin(1e-12));
    CHECK(glm::length(glm::cross(moved - across, towards)) == Approx(0).margin(1e-12));
}
