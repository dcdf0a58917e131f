// SPDX-License-Identifier: MIT
// Bounds from moments against values worked out with many digits, against linear programming, against the true ψ of
// random distributions, and float against double.
#include "tests/catch.h"
#include "tests/numerics/algorithm1.h"
#include "tests/numerics/glsl_cpp.h"
#include "tests/numerics/moments_golden.h"

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace {

namespace test = penumbra::test;
using glm::dvec2;
using glm::dvec4;

// Atoms of depth.
struct Distribution {
    struct Atom {
        double z, weight;
    };
    std::vector<Atom> atoms;

    template <class Function> auto mean(Function&& f) const {
        auto sum = atoms[0].weight * f(atoms[0].z);
        for (size_t i = 1; i < atoms.size(); ++i) sum += atoms[i].weight * f(atoms[i].z);
        return sum;
    }
    dvec4 powers() const {
        return mean([](double z) { return f64::powersOf(z); });
    }
    double inFront(double z_f) const {
        double sum = 0;
        for (const Atom& atom : atoms) sum += atom.z < z_f ? atom.weight : 0;
        return sum;
    }
};

// One to eight surfaces, with the nasty ones among them: at 0 and 1, nearly equal, of hardly any weight.
class Distributions {
public:
    explicit Distributions(unsigned seed) : random_(seed) {}
    double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

    Distribution next() {
        Distribution d;
        const int count = 1 + below(8), style = below(5);
        const bool clustered = unit() < 0.3;
        const double base = 0.98 * unit();
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            double z = clustered ? base + 0.02 * unit() : unit();
            if (i == 0 && style < 2) z = style;
            const double weight = (style == 2 ? std::pow(unit(), 6) : unit()) + 1e-6;
            d.atoms.push_back({z, weight});
            sum += weight;
        }
        for (Distribution::Atom& atom : d.atoms) atom.weight /= sum;
        return d;
    }
    // Anywhere, or on either side of a surface at 0.1 to 1e-7 of the range.
    double fragment(const Distribution& d) {
        if (unit() < 0.5) return unit();
        const double away = std::pow(10, -1 - 6 * unit());
        const double z = d.atoms[static_cast<size_t>(below(static_cast<int>(d.atoms.size())))].z;
        return std::clamp(z + (unit() < 0.5 ? away : -away), 0.0, 1.0);
    }

private:
    std::mt19937 random_;
};

const std::map<std::string, Distribution> named{
    {"D3", {{{0.2, 0.3}, {0.5, 0.3}, {0.8, 0.4}}}},
    {"D4", {{{0.1, 0.25}, {0.3, 0.25}, {0.6, 0.25}, {0.9, 0.25}}}},
    {"E3", {{{0.02, 0.2}, {0.5, 0.5}, {0.97, 0.3}}}},
    {"S1", {{{0.5, 1}}}},
    {"S2", {{{0.25, 0.5}, {0.75, 0.5}}}},
    {"S3", {{{0.4, 0.3}, {0.5, 0.7}}}},
    {"S4", {{{0.1, 0.9}, {0.9, 0.1}}}},
};

// Even over an interval where they have no atoms.
dvec4 powerMoments(const std::string& name) {
    if (name == "U01") return {0.5, 1.0 / 3, 0.25, 0.2};
    if (name == "U46") return {0.5, 0.25333333333333333, 0.13, 0.06752};
    return named.at(name).powers();
}

dvec4 trigonometricMoments(const std::string& name) {
    const auto mean = [](double k, double low, double high) {
        const double a = 2 * M_PI * k * low, b = 2 * M_PI * k * high;
        return dvec2(std::cos(a) - std::cos(b), std::sin(b) - std::sin(a)) / (b - a);
    };
    const auto even = [&](double low, double high) { return dvec4(mean(1, low, high), mean(2, low, high)); };
    if (name == "U01") return even(0, 1);
    if (name == "U46") return even(0.4, 0.6);
    return named.at(name).mean([](double z) { return f64::trigonometricOf(z); });
}

dvec4 biased(dvec4 b, double alpha, dvec4 target = dvec4(0.5)) { return b + alpha * (target - b); }

const f64::DepthRange exact{0, 1, 1e-300, 1e-300};

// What a lookup in a 32-bit map passes on (renderer/shadow_map/moment_map.cpp).
f32::DepthRange rangeOf(double alpha) {
    return {0, 1, float(std::max(alpha / 4, 1e-7)), float(std::max(alpha / 128, 1e-9))};
}
f32fused::DepthRange alike(const f32::DepthRange& r) { return {r.low, r.high, r.leastVariance, r.leastPivot}; }

// The least mass in front of v that atoms at `grid` can have with the moments E vᵏ, k = 0, 1 ...
double leastMass(std::vector<double> grid, double v, const std::vector<double>& moments) {
    std::sort(grid.begin(), grid.end());
    grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
    test::Algorithm1 problem(moments);
    for (const double u : grid) {
        test::Column column{.inFront = u < v};
        for (size_t k = 0; k < moments.size(); ++k) column.rows[k] = std::pow(u, static_cast<int>(k));
        problem.add(column);
    }
    return problem.solve();
}

// Standardised depths for a linear program: even over where depths are likely, and those that must be among them.
std::vector<double> gridOver(double low, double high, std::initializer_list<double> needed) {
    std::vector<double> grid;
    for (int i = 0; i <= 60; ++i) grid.push_back(low + (high - low) * i / 60);
    for (const double u : needed)
        if (std::isfinite(u) && u >= low && u <= high) grid.push_back(u);
    return grid;
}

} // namespace

TEST_CASE("bounds of moments have their golden values") {
    for (const golden::Row& row : golden::hamburger)
        for (size_t i = 0; i < std::size(golden::depths); ++i) {
            CAPTURE(row.distribution, row.alpha, golden::depths[i]);
            const dvec4 b = biased(powerMoments(row.distribution), row.alpha);
            CHECK(f64::hamburgerBound(b, golden::depths[i], exact) == Approx(row.psi[i]).margin(1e-9));
            // In float rounding decides in the third digit where there are but one or two surfaces.
            const glm::vec4 single(b);
            const auto z_f = float(golden::depths[i]);
            CHECK(f32::hamburgerBound(single, z_f, rangeOf(row.alpha)) == Approx(row.psi[i]).margin(3e-3));
            CHECK(f32fused::hamburgerBound(single, z_f, alike(rangeOf(row.alpha))) == Approx(row.psi[i]).margin(3e-3));
        }
    for (const golden::Row& row : golden::hausdorff)
        for (size_t i = 0; i < std::size(golden::depths); ++i) {
            CAPTURE(row.distribution, row.alpha, golden::depths[i]);
            const dvec4 b = biased(powerMoments(row.distribution), row.alpha);
            CHECK(f64::hausdorffBound(b, golden::depths[i], exact) == Approx(row.psi[i]).margin(1e-9));
            const glm::vec4 single(b);
            const auto z_f = float(golden::depths[i]);
            CHECK(f32::hausdorffBound(single, z_f, rangeOf(row.alpha)) == Approx(row.psi[i]).margin(3e-3));
            CHECK(f32fused::hausdorffBound(single, z_f, alike(rangeOf(row.alpha))) == Approx(row.psi[i]).margin(3e-3));
        }
    for (const golden::Row& row : golden::trigonometric)
        for (size_t i = 0; i < std::size(golden::depths); ++i) {
            CAPTURE(row.distribution, golden::depths[i]);
            const dvec4 b = trigonometricMoments(row.distribution);
            // 2π is a float's here and in the shader: 3e-8.
            CHECK(f64::trigonometricBound(b, golden::depths[i], 1e-300) == Approx(row.psi[i]).margin(1e-6));
            const glm::vec4 single(b);
            const auto z_f = float(golden::depths[i]);
            CHECK(f32::trigonometricBound(single, z_f, 1e-7f) == Approx(row.psi[i]).margin(1e-5));
            CHECK(f32fused::trigonometricBound(single, z_f, 1e-7f) == Approx(row.psi[i]).margin(1e-5));
        }
}

TEST_CASE("bounds of four powers are what linear programming finds") {
    Distributions distributions(1);
    int compared = 0, unsolved = 0;
    double worst = 0, worstInside = 0;
    for (int i = 0; i < 1500; ++i) {
        const Distribution d = distributions.next();
        const double z_f = distributions.fragment(d);
        const dvec4 b = d.powers();
        const f64::Standardised s = f64::standardised(b, exact);
        const double v = (z_f - s.mean) * s.perSigma;
        const double kurtosis = s.kurtosis;
        // The smallest pivot: of the matrix in units of the depth range.
        const double variance = 1 / (s.perSigma * s.perSigma);
        if (std::min(variance, s.spread * variance * variance) < 1e-8) continue;
        const f64::ThreeAtoms a = f64::threeAtoms(s, v);
        const double far = 1 / a.perFar;
        const std::vector<double> moments{1, 0, 1, s.skew, kurtosis};
        const double reach = std::min(2 * std::max({std::abs(a.near), std::abs(far), std::abs(v), 4.0}), 1e3);
        const double line = leastMass(gridOver(-reach, reach, {v, a.near, far}), v, moments);
        const double low = -s.mean * s.perSigma, high = (1 - s.mean) * s.perSigma;
        const double pull = f64::cubicMean(s, low, high, v);
        const double fourth = (kurtosis - s.skew * (low + high + v) + low * high + v * (low + high)) / pull;
        const double interval = leastMass(gridOver(low, high, {v, a.near, far, fourth, low, high}), v, moments);
        if (!std::isfinite(line) || !std::isfinite(interval)) {
            ++unsolved;
            continue;
        }
        ++compared;
        worst = std::max(worst, std::abs(f64::hamburgerBound(b, z_f, exact) - line));
        const double inside = std::abs(f64::hausdorffBound(b, z_f, exact) - interval);
        worstInside = std::max(worstInside, inside);
    }
    CAPTURE(compared, unsolved, worst, worstInside);
    CHECK(compared > 700);
    CHECK(unsolved < 0.02 * compared);
    CHECK(worst < 1e-6);
    CHECK(worstInside < 1e-6);
}

namespace {

// Of depths in [0, 1], as the map keeps them: in [−1, 1]. `alpha` of the arcsine distribution is mixed in.
f64::SixMoments sixMoments(const Distribution& d, double alpha) {
    static constexpr double arcsine[] = {0, 0.5, 0, 0.375, 0, 0.3125};
    double b[6];
    for (int k = 0; k < 6; ++k) {
        b[k] = d.mean([&](double z) { return std::pow(2 * z - 1, k + 1); });
        b[k] += alpha * (arcsine[k] - b[k]);
    }
    return {b[0], b[1], b[2], b[3], b[4], b[5]};
}
glm::dvec3 leastNorms(double alpha) { return glm::max(alpha * glm::dvec3(0.5, 0.125, 0.03125), 1e-300); }

} // namespace

TEST_CASE("the bound of six powers has its golden values, and gives three surfaces exactly") {
    // By 120 digits from algorithm 2 as the paper has it.
    const Distribution d4 = named.at("D4");
    const Distribution d5{{{0.05, 0.1}, {0.2, 0.3}, {0.5, 0.2}, {0.7, 0.25}, {0.98, 0.15}}};
    struct Row {
        const Distribution& d;
        double alpha, psi[5]; // at 0.2, 0.45, 0.65, 0.75, 0.95
    };
    const double depths[] = {0.2, 0.45, 0.65, 0.75, 0.95};
    const Row rows[] = {
        {d4, 0, {0.1027149913882, 0.3324392171314, 0.5564862328041, 0.624464668966, 0.8945654129556}},
        {d5, 0, {0.06464106385834, 0.3051487894328, 0.4795446614237, 0.6057564004312, 0.7937534956261}},
        {named.at("D3"), 1e-4, {1.239054767712e-6, 0.299676542653, 0.5989903781236, 0.5996050216944, 0.9999346363182}},
        {named.at("S2"), 1e-4, {0, 0.499791641867, 0.4999325817988, 0.5000029755127, 0.9999696808514}}};
    for (const Row& row : rows)
        for (int i = 0; i < 5; ++i) {
            CAPTURE(&row - rows, depths[i]);
            const double x = 2 * depths[i] - 1;
            CHECK(f64::sixMomentsBound(sixMoments(row.d, row.alpha), x, leastNorms(row.alpha)) ==
                  Approx(row.psi[i]).margin(1e-8));
        }
    Distributions distributions(8);
    for (int i = 0; i < 1000; ++i) {
        const double near = 0.3 * distributions.unit();
        const Distribution three{{{near, 0.3}, {near + 0.3, 0.3}, {near + 0.65, 0.4}}};
        for (const double z_f : {near + 0.05, near + 0.25, near + 0.35, near + 0.6, near + 0.7}) {
            CAPTURE(near, z_f);
            CHECK(f64::sixMomentsBound(sixMoments(three, 1e-10), 2 * z_f - 1, leastNorms(1e-10)) ==
                  Approx(three.inFront(z_f)).margin(1e-4));
        }
    }
}

TEST_CASE("the bound of six powers is what linear programming finds, sharper than that of four, and none above ψ") {
    Distributions distributions(9);
    int compared = 0, unsolved = 0;
    double worst = 0;
    for (int i = 0; i < 4000; ++i) {
        const Distribution d = distributions.next();
        const double z_f = distributions.fragment(d);
        CAPTURE(i, z_f);
        {
            const double alpha = std::pow(10, -6 + 3 * distributions.unit());
            const double psi = f64::sixMomentsBound(sixMoments(d, alpha), 2 * z_f - 1, leastNorms(alpha));
            const double truth = d.inFront(z_f + 1e-6);
            if (psi > truth + alpha + 1e-5) CHECK(psi <= truth + alpha + 1e-5);
        }
        const f64::SixMoments m = sixMoments(d, 0);
        const f64::Recurrence r = f64::recurrenceOf(m, glm::dvec3(1e-300));
        if (r.d3 < 1e-6) continue;
        const double psi = f64::sixMomentsBound(m, 2 * z_f - 1, glm::dvec3(1e-300));
        CHECK(psi >= f64::hamburgerBound(d.powers(), z_f, exact) - 1e-7);
        const f64::FourAtoms atoms = f64::fourAtoms(r, 2 * z_f - 1);
        // Standardised: x = a0 + √D1 v. Sixth powers of what lies farther out are more than the solver can weigh.
        const double sigma = std::sqrt(r.d1), v = (2 * z_f - 1 - r.a0) / sigma;
        std::vector<double> grid = gridOver(-4, 4, {v});
        for (int j = 0; j < 3; ++j) grid.push_back(v + 1 / (sigma * atoms.s[j]));
        if (std::any_of(grid.begin(), grid.end(), [](double u) { return std::abs(u) > 50; }) || std::abs(v) > 4)
            continue;
        std::vector<double> moments;
        for (int k = 0; k <= 6; ++k)
            moments.push_back(d.mean([&](double z) { return std::pow((2 * z - 1 - r.a0) / sigma, k); }));
        const double least = leastMass(grid, v, moments);
        if (!std::isfinite(least)) {
            ++unsolved;
            continue;
        }
        ++compared;
        worst = std::max(worst, std::abs(psi - least));
    }
    CAPTURE(compared, unsolved, worst);
    CHECK(compared > 500);
    CHECK(unsolved < 0.1 * compared);
    CHECK(worst < 1e-6);
}

TEST_CASE("algorithm 1 of any functions finds the bounds that are known in closed form") {
    using Function = double (*)(double);
    const std::vector<Function> powers{[](double z) { return z; }, [](double z) { return z * z; },
                                       [](double z) { return z * z * z; }, [](double z) { return z * z * z * z; }};
    const std::vector<Function> chebyshev{[](double z) { return 2 * z - 1; },
                                          [](double z) { return std::cos(2 * std::acos(2 * z - 1)); },
                                          [](double z) { return std::cos(3 * std::acos(2 * z - 1)); },
                                          [](double z) { return std::cos(4 * std::acos(2 * z - 1)); }};
    const std::vector<Function> turns{
        [](double z) { return std::sin(2 * M_PI * z); }, [](double z) { return std::cos(2 * M_PI * z); },
        [](double z) { return std::sin(4 * M_PI * z); }, [](double z) { return std::cos(4 * M_PI * z); }};
    Distributions distributions(12);
    double worstPowers = 0, worstSpan = 0, worstTurns = 0;
    int unsolved = 0, compared = 0;
    for (int i = 0; i < 150; ++i) {
        const Distribution d = distributions.next();
        const double z_f = distributions.fragment(d);
        std::vector<test::Atom> atoms;
        for (const Distribution::Atom& atom : d.atoms) atoms.push_back({atom.z, atom.weight});
        const dvec4 b = d.powers();
        const f64::Standardised s = f64::standardised(b, exact);
        const double variance = 1 / (s.perSigma * s.perSigma);
        if (std::min(variance, s.spread * variance * variance) < 1e-8) continue;
        const double four = test::sharpBound(powers, atoms, z_f), same = test::sharpBound(chebyshev, atoms, z_f);
        const double turning = test::sharpBound(turns, atoms, z_f);
        if (!std::isfinite(four + same + turning)) {
            ++unsolved;
            continue;
        }
        ++compared;
        CAPTURE(i, z_f, four, same, turning);
        worstPowers = std::max(worstPowers, std::abs(four - f64::hausdorffBound(b, z_f, exact)));
        worstSpan = std::max(worstSpan, std::abs(four - same));
        const dvec4 t = d.mean([](double z) { return f64::trigonometricOf(z); });
        worstTurns = std::max(worstTurns, std::abs(turning - f64::trigonometricBound(t, z_f, 1e-300)));
    }
    CAPTURE(compared, unsolved, worstPowers, worstSpan, worstTurns);
    CHECK(compared > 50);
    CHECK(unsolved < 0.05 * compared);
    CHECK(worstPowers < 1e-6);
    CHECK(worstSpan < 1e-6); // the same functions, otherwise combined
    CHECK(worstTurns < 1e-5);
}

TEST_CASE("layers of a square wave add up to its series") {
    // S(x) at golden places: its first maximum and first trough for 4 and 16 terms, and ½ at 0.
    const auto series = [](double z, double t, int terms) {
        double sum = 0.5;
        for (int layer = 0; layer < (terms + 1) / 2; ++layer)
            sum += f64::squareWaveAt(f64::squareWaveOf(z, layer), t, layer, terms, 0.0);
        return sum;
    };
    for (const double t : {0.0, 0.3, 0.7}) {
        CAPTURE(t);
        CHECK(series(t, t, 16) == Approx(0.5).margin(1e-6));
        CHECK(series(t + 1.0 / 2, t, 1) == Approx(1.13661977237).margin(1e-6));
        CHECK(series(t + 1.0 / 8, t, 4) == Approx(1.09211256669).margin(1e-6));
        CHECK(series(t + 1.0 / 4, t, 4) == Approx(0.945870937525).margin(1e-6));
        CHECK(series(t + 1.0 / 32, t, 16) == Approx(1.08965270445).margin(1e-6));
        CHECK(series(t + 1.0 / 16, t, 16) == Approx(0.951084900927).margin(1e-6));
        CHECK(series(t - 1.0 / 32, t, 16) == Approx(1 - 1.08965270445).margin(1e-6));
    }
}

TEST_CASE("variance and warped variance bounds are Cantelli's inequality") {
    // Half of the depths at 0.25 and half at 0.75.
    const dvec2 b(0.5, 0.3125);
    CHECK(f64::varianceBound(b, 0.5, 0.0) == 0);
    CHECK(f64::varianceBound(b, 0.75, 0.0) == Approx(0.5));
    CHECK(f64::varianceBound(b, 0.8, 0.0) == Approx(1 - 0.409836065574).epsilon(1e-9));
    CHECK(f64::withoutBleeding(1 - 0.409836065574, 0.2) == Approx(1 - 0.262295081967).epsilon(1e-6));
    CHECK(f64::withoutBleeding(0.9, 0.5) == 1);
    const auto warped = [](double c, double z, bool negative) {
        const double x = 2 * z - 1;
        return negative ? -std::exp(-c * x) : std::exp(c * x);
    };
    const auto bound = [&](double c, double z_f, bool negative) {
        const double p = warped(c, 0.25, negative), q = warped(c, 0.75, negative);
        return f64::warpedVarianceBound(dvec2(p + q, p * p + q * q) * 0.5, warped(c, z_f, negative), 0.0);
    };
    CHECK(bound(5.54, 0.8, false) == Approx(1 - 0.139249248083).epsilon(1e-9));
    CHECK(bound(40, 0.8, false) == Approx(1 - 8.54157745577e-5).epsilon(1e-9));
    CHECK(bound(5.54, 0.5, true) == Approx(1 - 0.562416923019).epsilon(1e-9));
    CHECK(bound(40, 0.5, true) == Approx(1 - 0.500000002061).epsilon(1e-9));
    // At the ends of what a float holds.
    for (const float c : {0.5f, 5.54f, 44.0f})
        for (const float x : {-1.0f, -0.3f, 0.0f, 1.0f})
            for (const float x_f : {-1.0f, 0.0f, 1.0f})
                for (const float sign : {1.0f, -1.0f}) {
                    const float w = sign * std::exp(sign * c * x), w_f = sign * std::exp(sign * c * x_f);
                    const float psi = f32::warpedVarianceBound(glm::vec2(w, w * w), w_f, 0.0f);
                    CAPTURE(c, x, x_f, sign, psi);
                    CHECK(psi >= 0);
                    CHECK(psi <= 1);
                    if (x_f <= x) CHECK(psi < 1e-5f);
                    if (c * (x_f - x) > 10) CHECK(psi > 0.99f);
                }
}

TEST_CASE("algorithm 2 is Cantelli's inequality for two moments, algorithm 3 for four, and ours for six") {
    // For any even number of moments, with all digits: the monic orthogonal polynomials P_j by Stieltjes' procedure on
    // the depths themselves; K(u) = Σ P_j(z_f) P_j(u) / D_j is 0 at the other atoms, and 1 / K(u, u) is what one
    // weighs.
    using real = long double;
    const auto algorithm2 = [](const Distribution& d, int m, double fragment) {
        const int n = m / 2;
        std::vector<real> a, norms;
        const auto polynomials = [&](real u) {
            std::vector<real> p{1};
            for (int j = 0; j < static_cast<int>(a.size()) && j < n; ++j) {
                const auto i = static_cast<size_t>(j);
                p.push_back((u - a[i]) * p[i] - (j > 0 ? norms[i] / norms[i - 1] * p[i - 1] : 0));
            }
            return p;
        };
        for (int j = 0; j <= n; ++j) {
            real norm = 0, first = 0;
            for (const Distribution::Atom& atom : d.atoms) {
                const real p = polynomials(atom.z).back();
                norm += atom.weight * p * p, first += atom.weight * p * p * atom.z;
            }
            norms.push_back(norm);
            a.push_back(first / norm);
        }
        const auto kernel = [&](real u, real v) {
            const std::vector<real> p = polynomials(u), q = polynomials(v);
            real sum = 0;
            for (size_t j = 0; j <= static_cast<size_t>(n); ++j) sum += p[j] * q[j] / norms[j];
            return sum;
        };
        // Roots before the fragment are looked for in 1 / (z_f − u), which has no far end.
        real psi = 0;
        constexpr int steps = 20000;
        const auto place = [&](int i) { return fragment - (1 / (real(i) / steps) - 1); };
        const auto atRoot = [&](real low, real high) {
            for (int i = 0; i < 80; ++i) {
                const real middle = (low + high) / 2;
                (kernel(fragment, low) < 0) == (kernel(fragment, middle) < 0) ? low = middle : high = middle;
            }
            return 1 / kernel(low, low);
        };
        for (int i = 1; i < steps; ++i)
            if ((kernel(fragment, place(i)) < 0) != (kernel(fragment, place(i + 1)) < 0))
                psi += atRoot(place(i), place(i + 1));
        return static_cast<double>(psi);
    };
    Distributions random(11);
    for (int round = 0; round < 12; ++round) {
        Distribution d;
        for (int i = 0; i < 6; ++i) d.atoms.push_back({(i + random.unit()) / 6, (1 + random.unit()) / 9});
        double sum = 0;
        for (const Distribution::Atom& atom : d.atoms) sum += atom.weight;
        for (Distribution::Atom& atom : d.atoms) atom.weight /= sum;
        const double z_f = 0.1 + 0.8 * random.unit();
        const dvec4 b = d.powers();
        CAPTURE(round, z_f);
        CHECK(algorithm2(d, 2, z_f) == Approx(f64::varianceBound(dvec2(b), z_f, 0.0)).margin(1e-9));
        CHECK(algorithm2(d, 4, z_f) == Approx(f64::hamburgerBound(b, z_f, exact)).margin(1e-6));
        const double fifth = d.mean([](double z) { return std::pow(z, 5); });
        const double sixth = d.mean([](double z) { return std::pow(z, 6); });
        CHECK(algorithm2(d, 6, z_f) ==
              Approx(f64::sixMomentsBound({b.x, b.y, b.z, b.w, fifth, sixth}, z_f, glm::dvec3(0.0))).margin(1e-4));
    }
}

TEST_CASE("what lies in front of a fragment is told with its mean depth where few surfaces make it up") {
    // Two surfaces are known from two moments where the fragment lies on the farther one, three from four moments.
    Distributions random(5);
    const auto check = [](const auto& found, double psi, double moment, double margin) {
        CHECK(found.psi == Approx(psi).margin(margin));
        CHECK(found.moment == Approx(moment).margin(margin));
    };
    for (int round = 0; round < 300; ++round) {
        std::vector<double> z{random.unit(), random.unit(), random.unit()},
            w{random.unit(), random.unit(), random.unit()};
        std::sort(z.begin(), z.end());
        if (z[1] - z[0] < 0.05 || z[2] - z[1] < 0.05) continue;
        for (double& weight : w) weight = 0.1 + weight;
        const double two = w[0] + w[1], three = two + w[2];
        const Distribution pair{{{z[0], w[0] / two}, {z[1], w[1] / two}}};
        const dvec4 p = pair.powers();
        check(f64::varianceInFront(dvec2(p), z[1], 0.0), w[0] / two, w[0] * z[0] / two, 1e-9);
        const Distribution triple{{{z[0], w[0] / three}, {z[1], w[1] / three}, {z[2], w[2] / three}}};
        const dvec4 b = triple.powers();
        check(f64::hamburgerInFront(b, z[2], exact), two / three, (w[0] * z[0] + w[1] * z[1]) / three, 1e-6);
        check(f64::hamburgerInFront(b, z[1], exact), w[0] / three, w[0] * z[0] / three, 1e-6);
        check(f64::hamburgerInFront(b, z[0], exact), 0, 0, 1e-6);
    }
    // Variance soft shadow mapping: z_occ = (z_avg − P t) / (1 − P); half of a window at 0.3, a quarter, two blockers,
    // a receiver whose fragment is biased.
    const auto occluder = [](const Distribution& d, double t) {
        const f64::InFront f = f64::varianceInFront(dvec2(d.powers()), t, 0.0);
        return f.moment / f.psi;
    };
    CHECK(occluder({{{0.3, 0.5}, {0.8, 0.5}}}, 0.8) == Approx(0.3));
    CHECK(occluder({{{0.3, 0.5}, {0.8, 0.5}}}, 0.79) == Approx(0.289583333333));
    CHECK(occluder({{{0.3, 0.25}, {0.8, 0.75}}}, 0.8) == Approx(0.3));
    CHECK(occluder({{{0.2, 0.25}, {0.4, 0.25}, {0.8, 0.5}}}, 0.8) == Approx(0.28));
}

TEST_CASE("where an atom of Hamburger's bound passes through infinity it neither jumps nor loses digits") {
    // Even over [0, 1]; c3 = 0 at the roots of 6z² − 6z + 1.
    const dvec4 b(0.5, 1.0 / 3, 0.25, 0.2);
    const double roots[] = {0.21132486540518711775, 0.78867513459481288225};
    struct Row {
        double beside, psi[2];
    };
    for (const Row& row :
         {Row{-1e-3, {0, 0.4982799963878}}, Row{-1e-6, {0, 0.4999982679612}}, Row{0, {0, 0.5}},
          Row{1e-6, {4.499875294421e-21, 0.5000017320628}}, Row{1e-3, {4.377349007775e-9, 0.5017439984609}}})
        for (int i = 0; i < 2; ++i) {
            CAPTURE(i, row.beside);
            CHECK(f64::hamburgerBound(b, roots[i] + row.beside, exact) == Approx(row.psi[i]).margin(1e-11));
            CHECK(f32::hamburgerBound(glm::vec4(b), float(roots[i] + row.beside), rangeOf(0)) ==
                  Approx(row.psi[i]).margin(2e-6));
        }
    for (const double root : roots) {
        float z = float(root);
        for (int i = 0; i < 2000; ++i) z = std::nextafter(z, 0.0f);
        for (int i = 0; i < 4000; ++i, z = std::nextafter(z, 1.0f)) {
            const double difference =
                f32::hamburgerBound(glm::vec4(b), z, rangeOf(0)) - f64::hamburgerBound(b, z, exact);
            if (std::abs(difference) < 1e-6) continue;
            CAPTURE(z, difference);
            CHECK(std::abs(difference) < 1e-6);
        }
    }
}

TEST_CASE("two surfaces are reconstructed exactly as the moment bias goes to 0") {
    Distributions distributions(2);
    for (int i = 0; i < 2000; ++i) {
        Distribution d{{{0.02 + 0.7 * distributions.unit(), distributions.unit()}, {0, 0}}};
        d.atoms[1] = {d.atoms[0].z + 0.05 + 0.15 * distributions.unit(), 1 - d.atoms[0].weight};
        for (const double z_f : {d.atoms[0].z - 0.02, d.atoms[0].z + 0.02, d.atoms[1].z - 0.02, d.atoms[1].z + 0.02}) {
            CAPTURE(d.atoms[0].z, d.atoms[0].weight, d.atoms[1].z, z_f);
            const dvec4 b = biased(d.powers(), 1e-10);
            CHECK(f64::hamburgerBound(b, z_f, exact) == Approx(d.inFront(z_f)).margin(1e-4));
            CHECK(f64::hausdorffBound(b, z_f, exact) == Approx(d.inFront(z_f)).margin(1e-4));
        }
    }
}

TEST_CASE("without moment bias the near and far planes do not change the result") {
    Distributions distributions(3);
    int compared = 0;
    for (int i = 0; i < 5000; ++i) {
        const Distribution d = distributions.next();
        const double z_f = distributions.fragment(d);
        const f64::Standardised s = f64::standardised(d.powers(), exact);
        const double variance = 1 / (s.perSigma * s.perSigma);
        if (variance < 1e-4 || s.spread * variance * variance < 1e-6) continue;
        const double x = 0.1 + 0.8 * distributions.unit(), y = (1 - x) * distributions.unit();
        const dvec4 moved = d.mean([&](double z) { return f64::powersOf(x * z + y); });
        const double psi = f64::hamburgerBound(d.powers(), z_f, exact);
        CAPTURE(x, y, z_f, s.spread);
        CHECK(f64::hamburgerBound(moved, x * z_f + y, {-1, 2, 1e-300, 1e-300}) == Approx(psi).margin(1e-5));
        ++compared;
    }
    CHECK(compared > 2000);
}

TEST_CASE("no bound is above the true shadow") {
    // In double: by no more than half of the moment bias, which puts half of itself at 0 (trigonometric: all of it),
    // and rounding: a surface counts at most 1e-6 of the range before it, and Hausdorff's four atoms lose digits where
    // one of them lies within 1e-5 of the fragment.
    Distributions distributions(4);
    const auto check = [](double bound, double truth) {
        if (bound > truth) CHECK(bound <= truth);
    };
    for (int i = 0; i < 20000; ++i) {
        const Distribution d = distributions.next();
        const double z_f = distributions.fragment(d), truth = d.inFront(z_f + 1e-6);
        const double alpha = std::pow(10, -6 + 4 * distributions.unit());
        CAPTURE(i, z_f, alpha);
        const dvec4 b = biased(d.powers(), alpha);
        const double hamburger = f64::hamburgerBound(b, z_f, {0, 1, alpha / 4, alpha / 128});
        const double hausdorff = f64::hausdorffBound(b, z_f, {0, 1, 1e-12, 1e-14});
        const bool beside = std::any_of(d.atoms.begin(), d.atoms.end(),
                                        [&](const Distribution::Atom& a) { return std::abs(a.z - z_f) < 1e-5; });
        check(hamburger, truth + alpha / 2 + 1e-6);
        check(hausdorff, truth + alpha / 2 + (beside ? 3e-3 : 1e-6));
        check(hamburger, hausdorff + 1e-6); // knowing more allows more
        const dvec4 t = biased(d.mean([](double z) { return f64::trigonometricOf(z); }), alpha, dvec4(0));
        check(f64::trigonometricBound(t, z_f, alpha), truth + alpha + 1e-5);
    }
}

TEST_CASE("no slice of the depth range bounds ψ from above") {
    Distributions distributions(10);
    for (int i = 0; i < 5000; ++i) {
        const Distribution d = distributions.next();
        const double z_f = distributions.fragment(d), truth = d.inFront(z_f + 1e-6);
        CAPTURE(i, z_f);
        const auto check = [&](double bound) {
            if (bound > truth + 1e-6) CHECK(bound <= truth);
        };
        const double slices = 1 + distributions.below(8), overlap = 0.5 * distributions.unit();
        for (int pair = 0; 2 * pair < slices; ++pair) {
            const dvec4 s = d.mean([&](double z) { return f64::slicesOf(z, pair, slices, overlap); });
            const dvec4 own = f64::slicesOf(z_f, pair, slices, overlap);
            check(f64::varianceBound(dvec2(s.x, s.y), own.x, 1e-12));
            check(f64::varianceBound(dvec2(s.z, s.w), own.z, 1e-12));
        }
    }
}
