// SPDX-License-Identifier: MIT
// A small figure 4 of Peters and Klein 2015: which functions of the depth are worth filtering? Of each choice of four
// the sharp bound by algorithm 1, and its error of the irradiance (renderer/measure/irradiance.h), over random surfaces
// that the light sees, layer by layer. Kernels are taken from the shadow map itself, without any format's rounding or
// moment bias. A fragment is moved before the plane of its own surface, over the whole kernel, and compared with
// percentage-closer filtering of just that depth: no bound is above it, and all of the error is light that leaks.
//
//     candidates SURFACES VIEW[=SCENE] ...        a table of so many surfaces of each view, as in docs/moments.md
#include "app/command_line.h"
#include "app/headless.h"
#include "renderer/renderer.h"
#include "renderer/surfaces.h"
#include "tests/numerics/algorithm1.h"
#include "tests/numerics/glsl_cpp.h"

#include <fmt/format.h>

#include <quadmath.h>

#include <atomic>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <thread>

namespace {

// 33 digits, for narrow kernels: of one that is a ten thousandth of the range wide four functions that are alike leave
// the sixteenth digit.
__extension__ using Quad = __float128;

long double pi(long double) { return acosl(-1); }
long double sine(long double x) { return sinl(x); }
long double cosine(long double x) { return cosl(x); }
long double exponential(long double x) { return expl(x); }
long double logarithm(long double x) { return logl(x); }
long double power(long double x, double k) { return powl(x, k); }
Quad pi(Quad) { return acosq(-1); }
Quad sine(Quad x) { return sinq(x); }
Quad cosine(Quad x) { return cosq(x); }
Quad exponential(Quad x) { return expq(x); }
Quad logarithm(Quad x) { return logq(x); }
Quad power(Quad x, double k) { return powq(x, k); }

} // namespace

template <> inline constexpr Quad penumbra::test::leastSquare<Quad> = 1e-50L;

namespace {

using namespace penumbra;
using test::Atom;

template <class T> using Function = std::function<T(T)>;
template <class T> struct Candidate {
    std::string name;
    std::vector<Function<T>> functions;
};

template <class T> Function<T> power(double k) {
    return [=](T z) { return power(z, k); };
}
template <class T> Function<T> sine(double k) {
    return [=](T z) { return sine(pi(z) * T(k) * z); };
}
template <class T> Function<T> cosine(double k) {
    return [=](T z) { return cosine(pi(z) * T(k) * z); };
}
template <class T> Function<T> exponential(double c) {
    return [=](T z) { return exponential(T(c) * z); };
}
template <class T> Function<T> rational(double c, int k) {
    return [=](T z) { return 1 / power(1 + T(c) * z, k); };
}
template <class T> Function<T> logarithm(double c) {
    return [=](T z) { return logarithm(1 + T(c) * z); };
}
template <class T> Function<T> step(double at, double c) {
    return [=](T z) { return 1 / (1 + exponential(T(c) * (T(at) - z))); };
}
template <class T> Function<T> bell(double at, double width) {
    return [=](T z) { return exponential(-(z - T(at)) * (z - T(at)) / T(2 * width * width)); };
}
template <class T> Function<T> slice(double low, double high, int k) {
    return [=](T z) { return power(std::clamp((z - T(low)) / T(high - low), T(0), T(1)), k); };
}

// Some are those of techniques; others are as good a guess as any.
template <class T> const std::vector<Candidate<T>>& candidates() {
    static const std::vector<Candidate<T>> all{
        {"z, z², z³, z⁴ (moments)", {power<T>(1), power<T>(2), power<T>(3), power<T>(4)}},
        {"sin, cos 2πz, 4πz (trigonometric moments)", {sine<T>(2), cosine<T>(2), sine<T>(4), cosine<T>(4)}},
        {"sin, cos 1.8πz, 3.6πz (with the near margin)", {sine<T>(1.8), cosine<T>(1.8), sine<T>(3.6), cosine<T>(3.6)}},
        {"sin, cos πz, 2πz", {sine<T>(1), cosine<T>(1), sine<T>(2), cosine<T>(2)}},
        {"sin, cos 2πz, 6πz", {sine<T>(2), cosine<T>(2), sine<T>(6), cosine<T>(6)}},
        {"cos πz, 2πz, 3πz, 4πz", {cosine<T>(1), cosine<T>(2), cosine<T>(3), cosine<T>(4)}},
        {"sin πz, 2πz, 3πz, 4πz", {sine<T>(1), sine<T>(2), sine<T>(3), sine<T>(4)}},
        {"z, z², sin 2πz, cos 2πz", {power<T>(1), power<T>(2), sine<T>(2), cosine<T>(2)}},
        {"z, z², sin 4πz, cos 4πz", {power<T>(1), power<T>(2), sine<T>(4), cosine<T>(4)}},
        {"z, z³, z⁵, z⁷", {power<T>(1), power<T>(3), power<T>(5), power<T>(7)}},
        {"z², z⁴, z⁶, z⁸", {power<T>(2), power<T>(4), power<T>(6), power<T>(8)}},
        {"z, z², z⁴, z⁸", {power<T>(1), power<T>(2), power<T>(4), power<T>(8)}},
        {"z, z⁴, z⁹, z¹⁶", {power<T>(1), power<T>(4), power<T>(9), power<T>(16)}},
        {"√z, z, z√z, z²", {power<T>(0.5), power<T>(1), power<T>(1.5), power<T>(2)}},
        {"exp z, 2z, 3z, 4z", {exponential<T>(1), exponential<T>(2), exponential<T>(3), exponential<T>(4)}},
        {"exp ±2z, ±4z", {exponential<T>(2), exponential<T>(-2), exponential<T>(4), exponential<T>(-4)}},
        {"exp ±5z, ±10z (exponential variance, 16 bits)",
         {exponential<T>(5), exponential<T>(-5), exponential<T>(10), exponential<T>(-10)}},
        {"exp 80z, 160z, −10z, −20z (exponential variance, 32 bits)",
         {exponential<T>(80), exponential<T>(160), exponential<T>(-10), exponential<T>(-20)}},
        {"z, z², exp ±10z", {power<T>(1), power<T>(2), exponential<T>(10), exponential<T>(-10)}},
        {"z, z², z³, exp 80z", {power<T>(1), power<T>(2), power<T>(3), exponential<T>(80)}},
        {"1 / (1 + z)ᵏ, k = 1 ... 4", {rational<T>(1, 1), rational<T>(1, 2), rational<T>(1, 3), rational<T>(1, 4)}},
        {"1 / (1 + 10z)ᵏ, k = 1 ... 4",
         {rational<T>(10, 1), rational<T>(10, 2), rational<T>(10, 3), rational<T>(10, 4)}},
        {"1 / (1 + cz), c = 1, 2, 4, 8", {rational<T>(1, 1), rational<T>(2, 1), rational<T>(4, 1), rational<T>(8, 1)}},
        {"log(1 + cz), c = 1, 4, 16, 64", {logarithm<T>(1), logarithm<T>(4), logarithm<T>(16), logarithm<T>(64)}},
        {"logistic steps of width 0.1", {step<T>(0.2, 10), step<T>(0.4, 10), step<T>(0.6, 10), step<T>(0.8, 10)}},
        {"logistic steps of width 0.03", {step<T>(0.2, 30), step<T>(0.4, 30), step<T>(0.6, 30), step<T>(0.8, 30)}},
        {"bells, σ 0.2", {bell<T>(0.125, 0.2), bell<T>(0.375, 0.2), bell<T>(0.625, 0.2), bell<T>(0.875, 0.2)}},
        {"bells, σ 0.1", {bell<T>(0.125, 0.1), bell<T>(0.375, 0.1), bell<T>(0.625, 0.1), bell<T>(0.875, 0.1)}},
        {"two slices (layered variance)",
         {slice<T>(0, 0.5, 1), slice<T>(0, 0.5, 2), slice<T>(0.5, 1, 1), slice<T>(0.5, 1, 2)}},
        // For comparison, of fewer functions or more.
        {"exp 80z", {exponential<T>(80)}},
        {"z, z² (variance)", {power<T>(1), power<T>(2)}},
        {"sin, cos 2πz", {sine<T>(2), cosine<T>(2)}},
        {"z, z², z³", {power<T>(1), power<T>(2), power<T>(3)}},
        {"z ... z⁶ (six moments)", {power<T>(1), power<T>(2), power<T>(3), power<T>(4), power<T>(5), power<T>(6)}},
    };
    return all;
}

// A surface that faces the light: what its kernel holds, its own depth, biased, and the share of the kernel in front.
struct Surface {
    std::vector<Atom> kernel;
    double z_f, shadow, deviation;
};

constexpr int mapSize = 1024, halfKernel = 4;
constexpr double sigma = 2.4, depthBias = 2e-5;

// Of the surfaces of all layers so many at random.
std::vector<Surface> surfacesOf(const std::string& view, size_t count) {
    const size_t equals = view.find('=');
    Options options;
    options.view = view.substr(0, equals);
    if (equals != std::string::npos) options.scene = view.substr(equals + 1);
    Shot shot;
    Session session = makeSession(options, shot);
    changeShape(session.light, LightShape::Directional);
    session.light.size = {0, 0};
    session.progressive = false;
    session.techniques.choose("hard");
    session.techniques.parameters().at("map-size").set(mapSize);
    Renderer renderer;
    const std::vector<LightLayer> layers = renderer.renderFromLight(session, mapSize, mostLightLayers);
    const LightViewBlock light = lightView(session.light, renderer.state().occluders(), {.size = mapSize});
    const View eyes = lightsView(light, renderer.state().occluders());
    const double eye = -(light.lightFromWorld * glm::vec4(eyes.eyeWorld, 1)).z; // where eye depth counts from
    const double texel = 2.0 * light.window.z / mapSize;                        // [m]
    const auto imageOf = [&](size_t layer, std::string_view label) {
        const std::string full = fmt::format("{}/{}", lightLayerName(static_cast<int>(layer)), label);
        return renderer.read(*renderer.flow().find(full)).values;
    };
    const std::vector<float> map = imageOf(0, "hard.shadow-map");

    std::vector<std::vector<float>> depths, normals;
    std::vector<std::pair<size_t, int>> places; // layer, texel
    for (size_t layer = 0; layer < layers.size(); ++layer) {
        depths.push_back(imageOf(layer, "scene.depth"));
        normals.push_back(imageOf(layer, "scene.normal"));
        for (int i = 0; i < mapSize * mapSize; ++i)
            if (depths[layer][static_cast<size_t>(i)] > 0) places.emplace_back(layer, i);
    }
    std::mt19937 random(1);
    std::shuffle(places.begin(), places.end(), random);
    if (places.size() > count) places.resize(count);

    double weights[halfKernel + 1], sum = 0;
    for (int i = 0; i <= halfKernel; ++i) weights[i] = std::exp(-i * i / (2 * sigma * sigma));
    for (int i = -halfKernel; i <= halfKernel; ++i) sum += weights[std::abs(i)];
    std::vector<Surface> surfaces;
    for (const auto& [layer, place] : places) {
        const auto at = static_cast<size_t>(place);
        const glm::vec3 normalWorld = f32::unitFromOctahedral({normals[layer][4 * at], normals[layer][4 * at + 1]});
        const glm::vec3 n = glm::mat3(light.lightFromWorld) * normalWorld;
        const double rise = halfKernel * texel * (std::abs(n.x) + std::abs(n.y)) / std::max(n.z, 1e-3f); // [m]
        Surface s{{}, (depths[layer][at] + eye - light.range.x - rise) * light.range.z - depthBias, 0, 0};
        const int x = place % mapSize, y = place / mapSize;
        double mean = 0, square = 0;
        for (int dy = -halfKernel; dy <= halfKernel; ++dy)
            for (int dx = -halfKernel; dx <= halfKernel; ++dx) {
                const bool inside = x + dx >= 0 && y + dy >= 0 && x + dx < mapSize && y + dy < mapSize;
                const double z = inside ? map[static_cast<size_t>((y + dy) * mapSize + x + dx)] : 1;
                const double weight = weights[std::abs(dx)] * weights[std::abs(dy)] / (sum * sum);
                s.kernel.push_back({z, weight});
                s.shadow += z < s.z_f ? weight : 0;
                mean += weight * z, square += weight * z * z;
            }
        s.deviation = std::sqrt(std::max(square - mean * mean, 0.0));
        surfaces.push_back(std::move(s));
    }
    return surfaces;
}

struct Error {
    double sum = 0, squares = 0; // of F − ψ in percent
    double above = 0;            // the most that ψ exceeds F
    size_t unsolved = 0;
};

Error errorOf(size_t candidate, const std::vector<Surface>& surfaces) {
    constexpr double narrow = 5e-3;
    Error error;
    for (const Surface& s : surfaces) {
        if (s.shadow == 0) continue; // nor is there a bound above
        double psi = NAN;
        if (s.deviation > narrow)
            psi = test::sharpBound(candidates<long double>()[candidate].functions, s.kernel, s.z_f);
        if (!std::isfinite(psi)) psi = test::sharpBound<Quad>(candidates<Quad>()[candidate].functions, s.kernel, s.z_f);
        if (!std::isfinite(psi)) psi = 0, ++error.unsolved;
        const double e = 100 * (s.shadow - psi);
        error.sum += e, error.squares += e * e, error.above = std::max(error.above, -e);
    }
    return error;
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw InputError("a number of surfaces and views were expected, candidates 600 courtyard");
        const size_t count = std::stoul(argv[1]);
        const std::vector<std::string> views(argv + 2, argv + argc);
        const HeadlessContext context;
        std::vector<std::vector<Surface>> surfaces;
        for (const std::string& view : views) surfaces.push_back(surfacesOf(view, count));
        struct Row {
            std::vector<Error> errors;
            double mean = 0, above = 0;
        };
        const auto& all = candidates<long double>();
        std::vector<Row> rows(all.size());
        std::atomic<size_t> next{0};
        const auto work = [&] {
            for (size_t i; (i = next++) < all.size();)
                for (const std::vector<Surface>& view : surfaces) {
                    const Error& error = rows[i].errors.emplace_back(errorOf(i, view));
                    rows[i].mean += error.sum / double(view.size()) / double(surfaces.size());
                    rows[i].above = std::max(rows[i].above, error.above);
                }
        };
        {
            std::vector<std::jthread> crew;
            for (unsigned i = 0; i < std::max(std::thread::hardware_concurrency(), 1u); ++i) crew.emplace_back(work);
        }
        std::vector<size_t> order(all.size());
        for (size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return rows[a].mean < rows[b].mean; });
        fmt::print("| functions | mean |");
        for (const std::string& view : views) fmt::print(" {} |", view.substr(0, view.find('=')));
        fmt::print("\n| --- |");
        for (size_t i = 0; i <= views.size(); ++i) fmt::print(" --- |");
        fmt::print("\n");
        double above = 0;
        for (const size_t i : order) {
            fmt::print("| {} | {:.2f} |", all[i].name, rows[i].mean);
            for (size_t v = 0; v < views.size(); ++v) {
                const Error& e = rows[i].errors[v];
                const double n = double(surfaces[v].size()), mean = e.sum / n;
                fmt::print(" {:.2f} ± {:.2f}{} |", mean, std::sqrt((e.squares / n - mean * mean) / n),
                           e.unsolved > 0 ? fmt::format(" ({} unsolved)", e.unsolved) : "");
            }
            fmt::print("\n");
            above = std::max(above, rows[i].above);
        }
        fmt::print(stderr, "The most that any bound was above: {:.4f} percent.\n", above);
    } catch (const std::exception& error) {
        fmt::print(stderr, "candidates: {}\n", error.what());
        return 2;
    }
}
