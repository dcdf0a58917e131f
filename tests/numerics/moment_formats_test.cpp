// SPDX-License-Identifier: MIT
// Bounds of moments as the formats of textures store them: every texel that can be stored, rounding against double, and
// the maps into the unit cube that make the most of 16 bits.
#include "tests/catch.h"
#include "tests/numerics/glsl_cpp.h"

#include <array>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace {

using glm::dmat4;
using glm::dvec4;

dmat4 fromRows(dvec4 a, dvec4 b, dvec4 c, dvec4 d) { return glm::transpose(dmat4(a, b, c, d)); }

enum class Stored { Float, Plain, Optimised };

// How a map keeps moments and a lookup reads them; renderer/shadow_map/moment_map.cpp, which the tests of the pipeline
// hold to the same values.
struct Keeping {
    const char* name;
    Stored stored;
    bool isSigned;
    dmat4 matrix{1};
    dvec4 offset{0};
    dvec4 target{0.5};
    double variance = 0.25, pivot = 1.0 / 128; // of the target, per moment bias

    Keeping(const char* n, Stored s, bool sign) : name(n), stored(s), isSigned(sign) {
        if (sign) {
            const double even = s == Stored::Float ? 0.375 : 0.628;
            target = {0, even, 0, even};
            variance = even, pivot = even * (1 - even);
        }
        if (s == Stored::Plain && sign)
            matrix = fromRows({0.5, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0.5, 0}, {0, 0, 0, 1}), offset = {0.5, 0, 0.5, 0};
        if (s != Stored::Optimised) return;
        const double r = std::sqrt(3.0);
        matrix = sign ? fromRows({1.5, 0, -2, 0}, {0, 4, 0, -4}, {r / 2, 0, -2 * r / 9, 0}, {0, 0.5, 0, 0.5})
                      : fromRows({-2.07224649, 32.2370378, -68.5710746, 39.3703274},
                                 {13.7948857, -59.4683976, 82.035975, -35.3649032},
                                 {0.105877704, -1.90774663, 9.34965551, -6.65434907},
                                 {9.79240621, -33.76521106, 47.9456097, -23.9728048});
        offset = sign ? dvec4(0.5, 0, 0.5, 0) : dvec4(0.0359558848, 0, 0, 0);
    }
    double depth(double z) const { return isSigned ? 2 * z - 1 : z; }
    glm::vec4 texel(dvec4 b) const {
        const dvec4 q = matrix * b + offset;
        if (stored == Stored::Float) return glm::vec4(b);
        return glm::vec4(glm::round(glm::clamp(q, 0.0, 1.0) * 65535.0) / 65535.0);
    }
    glm::vec4 read(glm::vec4 q, double alpha) const {
        const dmat4 inverse = (1 - alpha) * glm::inverse(matrix);
        return glm::mat4(inverse) * q + glm::vec4(alpha * target - inverse * offset);
    }
    f32::DepthRange range(double alpha) const {
        return {isSigned ? -1.0f : 0.0f, 1, float(std::max(alpha * variance, 1e-7)),
                float(std::max(alpha * pivot, 1e-9))};
    }
};

const Keeping keepings[] = {{"32f, unsigned", Stored::Float, false},
                            {"32f, signed", Stored::Float, true},
                            {"unorm16-optimised, unsigned", Stored::Optimised, false},
                            {"unorm16-optimised, signed", Stored::Optimised, true},
                            {"unorm16, unsigned", Stored::Plain, false},
                            {"unorm16, signed", Stored::Plain, true}};

struct Surfaces {
    std::vector<double> z, weight;
    double inFront(double z_f) const {
        double sum = 0;
        for (size_t i = 0; i < z.size(); ++i) sum += z[i] < z_f ? weight[i] : 0;
        return sum;
    }
};

// One to eight, 30 percent of them within 2 percent of the range, some at its ends, some of hardly any weight.
Surfaces randomSurfaces(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const size_t count = 1 + random() % 8;
    const unsigned style = random() % 5;
    const bool clustered = unit(random) < 0.3;
    const double base = 0.98 * unit(random);
    Surfaces s;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        double z = clustered ? base + 0.02 * unit(random) : unit(random);
        if (i == 0 && style < 2) z = style;
        s.z.push_back(z);
        s.weight.push_back((style == 2 ? std::pow(unit(random), 6) : unit(random)) + 1e-6);
        sum += s.weight.back();
    }
    for (double& w : s.weight) w /= sum;
    return s;
}

dvec4 momentsOf(const Surfaces& s, const Keeping& keeping) {
    dvec4 b(0);
    for (size_t i = 0; i < s.z.size(); ++i) b += s.weight[i] * f64::powersOf(keeping.depth(s.z[i]));
    return b;
}

// What the bounds of stored moments are off, over random surfaces and fragments.
struct Errors {
    int compared = 0, above = 0;                // by more than 0.001 the true shadow a thousandth of the range behind
    double worstAbove = 0, worst = 0, mean = 0; // above it; from double, with the same moment bias
    double lost = 0;                            // mean of the true shadow minus the bound
    std::array<int, 3> floors{};                // variance, pivot and discriminant
};

Errors errorsOf(const Keeping& keeping, double alpha, int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    Errors errors;
    for (int i = 0; i < count; ++i) {
        const Surfaces s = randomSurfaces(random);
        const dvec4 b = momentsOf(s, keeping);
        const glm::vec4 read = keeping.read(keeping.texel(b), alpha);
        const f32::DepthRange range = keeping.range(alpha);
        const double low = range.low;
        for (int j = 0; j < 4; ++j) {
            double z_f = unit(random);
            if (j >= 2) z_f = s.z[random() % s.z.size()] + (j == 2 ? -1 : 1) * std::pow(10, -1 - 6 * unit(random));
            if (z_f < 0 || z_f > 1) continue;
            const auto x_f = float(keeping.depth(z_f));
            const double psi = f32::hamburgerBound(read, x_f, range);
            const double right = f64::hamburgerBound(b + alpha * (keeping.target - b), double{x_f},
                                                     {low, 1, alpha * keeping.variance + 1e-30, 1e-30});
            const double over = psi - s.inFront(z_f + 1e-3);
            ++errors.compared;
            errors.above += over > 1e-3;
            errors.worstAbove = std::max(errors.worstAbove, over);
            errors.worst = std::max(errors.worst, std::abs(psi - right));
            errors.mean += std::abs(psi - right);
            errors.lost += s.inFront(z_f) - psi;
            const float variance = read.y - read.x * read.x;
            errors.floors[0] += variance < range.leastVariance;
            const f32::Standardised standard = f32::standardised(read, range);
            const float least = range.leastPivot * std::pow(standard.perSigma, 4.0f);
            errors.floors[1] += standard.spread <= least;
            const float v = (x_f - standard.mean) * standard.perSigma, k = v * (v - standard.skew) - 1;
            const float linear = standard.spread * v - standard.skew * k;
            errors.floors[2] += linear * linear - 4 * k * (standard.spread - k) < 0;
        }
    }
    errors.mean /= errors.compared;
    errors.lost /= errors.compared;
    return errors;
}

// No NaN, nothing outside [0, 1], whatever the texel.
int insaneTexels(size_t count) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<float> unit(0, 1);
    int insane = 0;
    const auto check = [&](float psi) { insane += !(psi >= 0 && psi <= 1); };
    for (size_t i = 0; i < count; ++i) {
        const uint64_t bits = random();
        // Bits as they come; or but a few of them, so that ends and corners are among them.
        const uint64_t texel = i % 4 == 0   ? (bits & random() & random())
                               : i % 4 == 1 ? (bits | random() | random())
                                            : bits;
        glm::vec4 q;
        for (int c = 0; c < 4; ++c) q[c] = float((texel >> (16 * c)) & 0xffff) / 65535.0f;
        const float z = i % 16 == 0 ? float(i / 16 % 2) : unit(random);
        for (const Keeping& keeping : keepings) {
            static constexpr double alphas[] = {0, 1e-7, 3e-5, 1e-2};
            const double alpha = alphas[i % 4];
            const glm::vec4 b = keeping.read(q, alpha);
            const f32::DepthRange range = keeping.range(alpha);
            const float x = keeping.isSigned ? 2 * z - 1 : z;
            check(f32::hamburgerBound(b, x, range));
            check(f32::hausdorffBound(b, x, range));
            check(f32fused::hamburgerBound(b, x, {range.low, range.high, range.leastVariance, range.leastPivot}));
            check(f32fused::hausdorffBound(b, x, {range.low, range.high, range.leastVariance, range.leastPivot}));
        }
        check(f32::varianceBound(glm::vec2(q), z, 1e-12f));
        const glm::vec4 b = 2.0f * q - 1.0f;
        const glm::vec3 norms =
            glm::max((i % 2 ? 1e-4f : 0.0f) * glm::vec3(0.5f, 0.125f, 0.03125f), {1e-7f, 1e-8f, 1e-9f});
        check(f32::sixMomentsBound({b.x, q.x, b.y, q.y, b.z, q.z}, 2 * z - 1, norms));
        check(f32fused::sixMomentsBound({b.x, q.x, b.y, q.y, b.z, q.z}, 2 * z - 1, norms));
        check(f32::trigonometricBound(2.0f * q - 1.0f, z, 1e-7f));
        check(f32fused::trigonometricBound(2.0f * q - 1.0f, z, 1e-7f));
    }
    return insane;
}

// log2 |det| of the best affine map of the moment curve z ... zᵐ over [0, 1] into the unit cube: rows are polynomials,
// here by Chebyshev's of 2z − 1, each scaled to its range. By random steps that keep what is better.
double bestStretch(int m, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    using Rows = std::array<std::array<double, 4>, 4>;
    constexpr int samples = 129;
    std::array<std::array<double, samples>, 4> chebyshev;
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < samples; ++i)
            chebyshev[size_t(k)][size_t(i)] = std::cos((k + 1) * M_PI * i / (samples - 1));
    const auto stretch = [&](const Rows& rows) {
        dmat4 matrix(1);
        double ranges = 0;
        for (int r = 0; r < m; ++r) {
            double low = 1e9, high = -1e9;
            for (size_t i = 0; i < samples; ++i) {
                double value = 0;
                for (int k = 0; k < m; ++k) value += rows[size_t(r)][size_t(k)] * chebyshev[size_t(k)][i];
                low = std::min(low, value), high = std::max(high, value);
            }
            for (int k = 0; k < m; ++k) matrix[k][r] = rows[size_t(r)][size_t(k)];
            ranges += std::log2(high - low);
        }
        return std::log2(std::abs(glm::determinant(matrix))) - ranges;
    };
    Rows best{};
    for (auto& row : best)
        for (double& x : row) x = normal(random);
    double most = stretch(best), step = 0.5;
    for (int i = 0; i < 100000 && step > 1e-8; ++i) {
        Rows tried = best;
        for (int k = 0; k < m; ++k) tried[size_t(i % m)][size_t(k)] += step * normal(random);
        const double stretched = stretch(tried);
        step *= stretched > most ? 1.5 : 0.98;
        if (stretched > most) most = stretched, best = tried;
    }
    // Chebyshev's polynomials of 2z − 1 have the leading coefficients 2, 8, 32, 128.
    static constexpr double leading[] = {1, 4, 9, 16};
    return most + leading[m - 1];
}

} // namespace

TEST_CASE("no storable texel gives NaN or a ψ outside [0, 1]") { CHECK(insaneTexels(200000) == 0); }
TEST_CASE("a hundred million texels give neither NaN nor a ψ outside [0, 1]", "[.figures]") {
    CHECK(insaneTexels(100000000) == 0);
}

TEST_CASE("with the usual moment bias stored moments are hardly ever above the true shadow") {
    const auto check = [](const Keeping& keeping, double alpha) {
        const Errors errors = errorsOf(keeping, alpha, 5000);
        CAPTURE(keeping.name, alpha, errors.compared, errors.above, errors.worstAbove, errors.floors[2]);
        CHECK(errors.above == 0);
        CHECK(errors.floors[2] < 0.01 * errors.compared);
    };
    check(keepings[0], 2e-6);
    check(keepings[1], 3e-7);
    check(keepings[2], 3e-5);
    check(keepings[3], 6e-5);
    // Without the optimised map 16 bits are not enough, nor is no bias.
    CHECK(errorsOf(keepings[4], 3e-5, 5000).above > 20);
    CHECK(errorsOf(keepings[2], 0, 5000).above > 20);
}

TEST_CASE("the maps of 16-bit moments stretch them as far as any affine map can") {
    const auto best = [](int m, int tries) {
        double most = -1e9;
        for (int i = 0; i < tries; ++i) most = std::max(most, bestStretch(m, unsigned(i) + 1));
        return most;
    };
    CHECK(best(2, 2) == Approx(2).margin(0.01));
    CHECK(best(3, 4) == Approx(std::log2(73.9)).margin(0.02));
    const double four = best(4, 10), ours = std::log2(std::abs(glm::determinant(keepings[2].matrix)));
    CAPTURE(four, ours);
    CHECK(ours == Approx(12.278).margin(0.001));
    CHECK(four > ours - 0.05);
    CHECK(four < ours + 0.002); // none is better, but for what lies between the samples
    // The curve stays in the unit cube.
    for (const Keeping& keeping : keepings)
        for (int i = 0; i <= 1000; ++i)
            if (keeping.stored != Stored::Float) {
                const dvec4 q = keeping.matrix * f64::powersOf(keeping.depth(i / 1000.0)) + keeping.offset;
                CHECK(glm::all(glm::greaterThanEqual(q, dvec4(-1e-7))));
                CHECK(glm::all(glm::lessThanEqual(q, dvec4(1 + 1e-7))));
            }
}

TEST_CASE("table of stored moments against double", "[.figures]") {
    std::printf("| texels | α | worst | mean | above ψ | worst above | light lost | floors: σ², D33, discriminant |\n"
                "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const Keeping& keeping : keepings)
        for (const double alpha : {0.0, 1e-7, 3e-7, 2e-6, 1e-5, 3e-5, 6e-5, 3e-4, 3e-3}) {
            const Errors e = errorsOf(keeping, alpha, 20000);
            const auto percent = [&](int i) { return 100.0 * e.floors[size_t(i)] / e.compared; };
            std::printf("| %s | %g | %.4f | %.5f | %d of %d | %.4f | %.4f | %.2f %%, %.2f %%, %.2f %% |\n",
                        keeping.name, alpha, e.worst, e.mean, e.above, e.compared, std::max(e.worstAbove, 0.0), e.lost,
                        percent(0), percent(1), percent(2));
        }
}
