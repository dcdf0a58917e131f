// SPDX-License-Identifier: MIT
// Bounds of moments as the formats of textures store them: every texel that can be stored, rounding against double, and
// the maps into the unit cube that make the most of 16 bits.
#include "tests/catch.h"
#include "tests/numerics/glsl_cpp.h"

#include <glm/gtc/packing.hpp>

#include <array>
#include <cstdio>
#include <future>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using glm::dmat4;
using glm::dvec4;

dmat4 fromRows(dvec4 a, dvec4 b, dvec4 c, dvec4 d) { return glm::transpose(dmat4(a, b, c, d)); }

enum class Stored { Float, Half, Plain, Optimised };

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
        if (stored == Stored::Half) return glm::unpackHalf(glm::packHalf(glm::vec4(b)));
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
                            {"unorm16, signed", Stored::Plain, true},
                            {"16f, unsigned", Stored::Half, false},
                            {"16f, signed", Stored::Half, true}};

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

// What is made of texels whatever their bits: by each member of the family, before what rounding has left is cut to
// [0, 1], and after it.
enum Member {
    Hamburger,
    Hausdorff,
    Six,
    Trigonometric,
    Variance,
    LayeredVariance,
    Exponential,
    ExponentialVariance,
    Convolution,
    members
};
constexpr const char* memberNames[members] = {"four moments",
                                              "four moments in the range",
                                              "six moments",
                                              "trigonometric moments",
                                              "variance",
                                              "a slice",
                                              "exponential",
                                              "exponential variance",
                                              "a layer of convolution"};
struct Texels {
    struct Cut { // of lookups
        uint64_t all = 0, notANumber = 0, below = 0, above = 0;
    };
    std::array<Cut, members> cut{};
    uint64_t texels = 0, fourMoments = 0;
    std::array<uint64_t, 4> floors{}; // variance, slope, pivot, discriminant; of four moments
    uint64_t insane = 0;              // NaN or outside [0, 1] after all

    void add(Member member, float raw, float psi) {
        Cut& c = cut[member];
        ++c.all;
        c.notANumber += std::isnan(raw), c.below += raw<0, c.above += raw> 1;
        insane += !(psi >= 0 && psi <= 1);
    }
    Texels& operator+=(const Texels& other) {
        for (size_t i = 0; i < members; ++i) {
            cut[i].all += other.cut[i].all, cut[i].notANumber += other.cut[i].notANumber;
            cut[i].below += other.cut[i].below, cut[i].above += other.cut[i].above;
        }
        for (size_t i = 0; i < floors.size(); ++i) floors[i] += other.floors[i];
        texels += other.texels, fourMoments += other.fourMoments, insane += other.insane;
        return *this;
    }
};

void fourMoments(Texels& t, glm::vec4 b, float x, const f32::DepthRange& range) {
    const f32fused::DepthRange same{range.low, range.high, range.leastVariance, range.leastPivot};
    const f32::Standardised s = f32::standardised(b, range);
    const float v = (x - s.mean) * s.perSigma;
    t.add(Hamburger, f32::inFrontOf(f32::threeAtoms(s, v)).psi, f32::hamburgerBound(b, x, range));
    t.add(Hausdorff, f32::hausdorffLeast(b, x, range), f32::hausdorffBound(b, x, range));
    const auto sane = [](float psi) { return psi >= 0 && psi <= 1; };
    t.insane += !sane(f32fused::hamburgerBound(b, x, same)) + !sane(f32fused::hausdorffBound(b, x, same));
    const f32::InFront f = f32::hamburgerInFront(b, x, range); // of soft moments: the mean depth is before the fragment
    t.insane += !sane(f.psi) || !(f.moment >= f.psi * range.low) || !(f.moment <= f.psi * x);

    ++t.fourMoments;
    const float variance = b.y - b.x * b.x, floored = std::max(variance, range.leastVariance);
    const float slope = (b.z - b.x * b.y) / floored, k = v * (v - s.skew) - 1, linear = s.spread * v - s.skew * k;
    t.floors[0] += variance < range.leastVariance;
    t.floors[1] += slope < 2 * range.low || slope > 2 * range.high;
    t.floors[2] += s.spread <= range.leastPivot / (floored * floored);
    t.floors[3] += linear * linear - 4 * k * (s.spread - k) < 0;
}

Texels randomTexels(size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Texels t;
    for (size_t i = 0; i < count; ++i) {
        const uint64_t bits = random();
        // Bits as they come; or but a few of them, so that ends and corners are among them.
        const uint64_t texel = i % 4 == 0   ? (bits & random() & random())
                               : i % 4 == 1 ? (bits | random() | random())
                                            : bits;
        glm::vec4 whole, half, both;
        for (int c = 0; c < 4; ++c) {
            auto word = static_cast<uint16_t>(texel >> (16 * c));
            whole[c] = float(word) / 65535.0f;
            both[c] = std::max(float(static_cast<int16_t>(word)) / 32767.0f, -1.0f);
            if ((word & 0x7c00) == 0x7c00) word &= 0xbfff; // finite, as all depths and exponents within limits are
            half[c] = glm::unpackHalf1x16(word);
        }
        const float z = i % 16 == 0 ? float(i / 16 % 2) : unit(random);
        static constexpr double alphas[] = {0, 1e-7, 3e-5, 1e-2};
        const double alpha = alphas[i % 4];
        for (const Keeping& keeping : keepings) {
            if (keeping.stored == Stored::Float) continue; // 16-bit patterns of it are those of the plain format
            const glm::vec4 b = keeping.read(keeping.stored == Stored::Half ? half : whole, alpha);
            fourMoments(t, b, keeping.isSigned ? 2 * z - 1 : z, keeping.range(alpha));
        }
        for (const glm::vec4& q : {whole, half}) {
            const float variance = f32::varianceBound(glm::vec2(q.x, q.y), z, 1e-12f);
            t.add(Variance, variance, f32::withoutBleeding(variance, 0.5f));
            const float optimised = f32::varianceBound(glm::vec2(q.x, q.x - q.y / 4), z, 1e-12f);
            t.add(Variance, optimised, f32::withoutBleeding(optimised, 0.95f));
            const float slice = f32::varianceBound(glm::vec2(q.z, q.w), f32::slicesOf(z, 0, 4, 0.05f).z, 1e-12f);
            t.add(LayeredVariance, slice, slice);
        }
        for (const glm::vec4& q : {both, half}) {
            const auto least = float(std::max(alpha, 1e-7));
            const glm::vec4 b = float(1 - alpha) * q;
            t.add(Trigonometric, f32::trigonometricLeast(b, z, least), f32::trigonometricBound(b, z, least));
            const float psi = f32fused::trigonometricBound(b, z, least);
            t.insane += !(psi >= 0 && psi <= 1);
            const float wave = 0.5f - f32::squareWaveAt(q, z, 0, 2, 1.0f);
            t.add(Convolution, wave, std::clamp(wave, 0.0f, 1.0f));
        }
        {
            const glm::vec2 c(5.54f, 5.54f);
            const float x = 2 * z - 1;
            const glm::vec2 deviation = float(i % 2) * 2e-3f * 2.0f * c;
            const float psi = std::max(f32::warpedVarianceBound({half.x, half.y}, std::exp(c.x * x), deviation.x),
                                       f32::warpedVarianceBound({half.z, half.w}, -std::exp(-c.y * x), deviation.y));
            t.add(ExponentialVariance, psi, f32::withoutBleeding(psi, 0.5f));
            const float dark = 1 - half.x * std::exp(-19.4f * (z - 0.5f));
            t.add(Exponential, dark, std::clamp(dark, 0.0f, 1.0f));
        }
        // Six are kept as 32-bit floats alone; of those the ones that 16 bits hold.
        const glm::vec3 norms =
            glm::max((i % 2 ? 1e-4f : 0.0f) * glm::vec3(0.5f, 0.125f, 0.03125f), {1e-7f, 1e-8f, 1e-9f});
        const f32::SixMoments m{both.x, whole.x, both.y, whole.y, both.z, whole.z};
        t.add(Six, f32::sixMomentsLeast(m, 2 * z - 1, norms), f32::sixMomentsBound(m, 2 * z - 1, norms));
        const float psi = f32fused::sixMomentsBound({m.b1, m.b2, m.b3, m.b4, m.b5, m.b6}, 2 * z - 1, norms);
        t.insane += !(psi >= 0 && psi <= 1);
        ++t.texels;
    }
    return t;
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

TEST_CASE("no storable texel gives NaN or a ψ outside [0, 1]") {
    const Texels t = randomTexels(60000, 6);
    CHECK(t.texels == 60000);
    CHECK(t.insane == 0);
    // The guards are not idle: without them there would be others. Two roots meet too rarely to be seen here.
    for (int i = 0; i < 3; ++i) CHECK(t.floors[size_t(i)] > 0);
    CHECK(t.cut[Exponential].below > 0);
}

TEST_CASE("a hundred million texels give neither NaN nor a ψ outside [0, 1]", "[.long]") {
    const unsigned crew = std::max(std::thread::hardware_concurrency(), 1u);
    std::vector<std::future<Texels>> parts;
    for (unsigned i = 0; i < crew; ++i)
        parts.push_back(std::async(std::launch::async, randomTexels, 100000000 / crew, 7 + i));
    Texels t;
    for (std::future<Texels>& part : parts) t += part.get();
    std::printf("| member | lookups | NaN | below 0 | above 1 |\n| --- | --- | --- | --- | --- |\n");
    const auto percent = [](uint64_t part, uint64_t all) { return 100 * double(part) / double(all); };
    for (size_t i = 0; i < members; ++i) {
        const Texels::Cut& c = t.cut[i];
        std::printf("| %s | %.1e | %.4f %% | %.4f %% | %.4f %% |\n", memberNames[i], double(c.all),
                    percent(c.notANumber, c.all), percent(c.below, c.all), percent(c.above, c.all));
    }
    std::printf("floors of four moments: variance %.2f %%, slope %.2f %%, pivot %.2f %%, discriminant %.4f %%\n",
                percent(t.floors[0], t.fourMoments), percent(t.floors[1], t.fourMoments),
                percent(t.floors[2], t.fourMoments), percent(t.floors[3], t.fourMoments));
    CHECK(t.insane == 0);
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
    check(keepings[3], 3e-5);
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
            if (keeping.stored == Stored::Plain || keeping.stored == Stored::Optimised) {
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
