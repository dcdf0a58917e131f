// SPDX-License-Identifier: MIT
// Errors of images that are known.
#include "renderer/measure/errors.h"
#include "renderer/measure/measurement.h"
#include "tests/catch.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

using namespace penumbra;

namespace {

using Psi = std::vector<float>;

Psi image(int width, int height, const std::function<float(int x, int y)>& value) {
    Psi values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) values.push_back(value(x, y));
    return values;
}

Truth truthOf(Psi psi, int width) {
    Truth truth;
    truth.width = width;
    truth.height = static_cast<int>(psi.size()) / width;
    truth.classes.assign(psi.size(), PixelClass::FacesWholeLight);
    truth.standardError.assign(psi.size(), 0);
    truth.psi = std::move(psi);
    truth.complete = true;
    return truth;
}

// A shadow's edge along x = 32 whose penumbra is `width` pixels wide, dark on the right.
float edge(int x, float width, float middle = 32) {
    return std::min(std::max((static_cast<float>(x) + 0.5f - middle) / width + 0.5f, 0.0f), 1.0f);
}
Psi edgeImage(float width, float middle = 32) {
    return image(64, 16, [&](int x, int) { return edge(x, width, middle); });
}

double sum(const std::array<double, errorKinds>& share) { return std::accumulate(share.begin(), share.end(), 0.0); }

} // namespace

TEST_CASE("figures of the vectors of the algorithm notes") {
    const Truth truth = truthOf({0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 0.5f}, 6);
    const Psi shadow{0.1f, 0.25f, 0.4f, 0.75f, 0.9f, 0.7f};
    const Errors errors = errorsOf(shadow, truth);
    CHECK(errors.all.meanAbsolute == Approx(0.0833333333333).epsilon(1e-6));
    CHECK(errors.all.rmse == Approx(0.108012344973).epsilon(1e-6));
    CHECK(errors.all.bias == Approx((0.1 - 0.1 - 0.1 + 0.2) / 6).epsilon(1e-6));
    CHECK(errors.all.max == Approx(0.2).epsilon(1e-6));
    CHECK(errors.pixels == 6);
    CHECK(errors.penumbraPixels == 4); // 0.25, 0.5, 0.75, 0.5
    CHECK(errors.penumbra.rmse == Approx(std::sqrt((0.01 + 0.04) / 4)).epsilon(1e-6));
    CHECK(errors.penumbra.bias == Approx(0.1 / 4).epsilon(1e-6));
    CHECK(errors.penumbra.max == Approx(0.2).epsilon(1e-6));
    CHECK(sum(errors.share) == Approx(1));
}

TEST_CASE("too dark is positive, too light is negative") {
    const Truth truth = truthOf(Psi(64, 0.5f), 8);
    CHECK(errorsOf(Psi(64, 0.625f), truth).all.bias == 0.125);
    CHECK(errorsOf(Psi(64, 0.375f), truth).all.bias == -0.125);
}

TEST_CASE("percentiles are those of the size of the error") {
    Psi shadow(1000);
    for (size_t i = 0; i < shadow.size(); ++i)
        shadow[i] = 0.5f + (i % 2 ? 1.0f : -1.0f) * static_cast<float>(i + 1) / 4096;
    const Errors errors = errorsOf(shadow, truthOf(Psi(1000, 0.5f), 100));
    CHECK(errors.all.p95 == 950.0 / 4096);
    CHECK(errors.all.p99 == 990.0 / 4096);
    CHECK(errors.all.max == 1000.0 / 4096);
}

TEST_CASE("only pixels that face the whole light count") {
    Truth truth = truthOf(Psi(6, 0.0f), 6);
    truth.classes = {PixelClass::FacesWholeLight, PixelClass::NoSurface,   PixelClass::CutByHorizon,
                     PixelClass::FacesAway,       PixelClass::BehindLight, PixelClass::FacesWholeLight};
    const Errors errors = errorsOf(Psi{0.5f, 1, 1, 1, 1, 0}, truth);
    CHECK(errors.pixels == 2);
    CHECK(errors.cutByHorizon == 1);
    CHECK(errors.all.meanAbsolute == 0.25);
    CHECK(errors.all.max == 0.5);

    truth.classes.assign(6, PixelClass::NoSurface);
    const Errors none = errorsOf(Psi(6, 1.0f), truth);
    CHECK(none.pixels == 0);
    CHECK(none.all.rmse == 0);
    CHECK(sum(none.share) == 0);
}

TEST_CASE("values that are not finite are counted and nothing else is made of them") {
    Psi shadow(25, 0.0f);
    shadow[7] = std::numeric_limits<float>::quiet_NaN();
    shadow[8] = std::numeric_limits<float>::infinity();
    const Errors errors = errorsOf(shadow, truthOf(Psi(25, 0.0f), 5));
    CHECK(errors.notFinite == 2);
    CHECK(std::isfinite(errors.all.rmse));
}

TEST_CASE("the truth itself has no error of any kind") {
    const Psi psi = edgeImage(12);
    const Errors errors = errorsOf(psi, truthOf(psi, 64));
    CHECK(errors.all.rmse == 0);
    CHECK(errors.all.max == 0);
    CHECK(sum(errors.share) == 0);
}

TEST_CASE("a wider penumbra is too wide, all of it") {
    const Errors errors = errorsOf(edgeImage(24), truthOf(edgeImage(12), 64));
    CHECK(errors.all.rmse > 0.05);
    CHECK(errors.shareOf(ErrorKind::Wide) == Approx(1).margin(1e-6));
}

TEST_CASE("a wider penumbra over an edge that is sharp in truth is too wide") {
    const Errors errors = errorsOf(edgeImage(16), truthOf(edgeImage(1e-3f), 64));
    CHECK(errors.shareOf(ErrorKind::Wide) == Approx(1).margin(1e-6));
}

TEST_CASE("a narrower penumbra, or none, is too narrow") {
    CHECK(errorsOf(edgeImage(6), truthOf(edgeImage(12), 64)).shareOf(ErrorKind::Narrow) == Approx(1).margin(1e-6));
    CHECK(errorsOf(edgeImage(1e-3f), truthOf(edgeImage(12), 64)).shareOf(ErrorKind::Narrow) == Approx(1).margin(1e-6));
}

TEST_CASE("a light spot in a shadow is a leak, a dark spot in the light is a false shadow") {
    // 8x8 pixels: too large for a median to take away.
    const auto spot = [](int x, int y) { return x >= 8 && x < 16 && y >= 4 && y < 12; };
    const Psi dark = image(32, 16, [&](int x, int y) { return spot(x, y) ? 0.75f : 1.0f; });
    const Errors leak = errorsOf(dark, truthOf(Psi(32 * 16, 1.0f), 32));
    // The median takes away the three pixels at each corner that have fewer than 13 of 25 neighbours in the spot.
    CHECK(leak.shareOf(ErrorKind::Leak) == Approx(52.0 / 64));
    CHECK(leak.shareOf(ErrorKind::Leak) + leak.shareOf(ErrorKind::Noise) == Approx(1));
    CHECK(leak.all.bias < 0);

    const Psi lit = image(32, 16, [&](int x, int y) { return spot(x, y) ? 0.25f : 0.0f; });
    const Errors shadow = errorsOf(lit, truthOf(Psi(32 * 16, 0.0f), 32));
    CHECK(shadow.shareOf(ErrorKind::FalseShadow) == Approx(52.0 / 64));
    CHECK(shadow.shareOf(ErrorKind::FalseShadow) + shadow.shareOf(ErrorKind::Noise) == Approx(1));
    CHECK(shadow.all.bias > 0);
}

TEST_CASE("a band of light inside of a shadow is a leak and not the fringe of its edge") {
    const Truth truth = truthOf(edgeImage(8), 64);
    const Psi shadow = image(64, 16, [](int x, int) { return x >= 48 && x < 56 ? 0.7f : edge(x, 8); });
    CHECK(errorsOf(shadow, truth).shareOf(ErrorKind::Leak) == Approx(1).margin(1e-6));
}

TEST_CASE("a shadow in the wrong place is shadow where none should be, beside what the penumbra lacks") {
    const Errors errors = errorsOf(edgeImage(1e-3f, 24), truthOf(edgeImage(1e-3f, 32), 64)); // 8 pixels too early
    CHECK(errors.shareOf(ErrorKind::FalseShadow) == Approx(1).margin(1e-6));
    CHECK(errorsOf(edgeImage(1e-3f, 40), truthOf(edgeImage(1e-3f, 32), 64)).shareOf(ErrorKind::Leak) ==
          Approx(1).margin(1e-6));
}

TEST_CASE("single pixels are noise, and what is below them keeps its kind") {
    const Truth truth = truthOf(Psi(64 * 16, 0.5f), 64);
    const Psi salted = image(64, 16, [](int x, int y) { return x % 4 == 1 && y % 4 == 1 ? 1.0f : 0.5f; });
    const Errors noise = errorsOf(salted, truth);
    CHECK(noise.shareOf(ErrorKind::Noise) == Approx(1));

    // Over a darkened penumbra: of a salted pixel's (0.5)² the median takes away all but (0.1)².
    const Psi both = image(64, 16, [](int x, int y) { return x % 4 == 1 && y % 4 == 1 ? 1.0f : 0.6f; });
    const Errors mixed = errorsOf(both, truth);
    const double salt = 0.25 - 0.01, rest = 0.01 * 16; // of 16 pixels one is salted
    CHECK(mixed.shareOf(ErrorKind::Noise) == Approx(salt / (salt + rest)).epsilon(1e-3));
    CHECK(mixed.shareOf(ErrorKind::Narrow) == Approx(rest / (salt + rest)).epsilon(1e-3));
}

TEST_CASE("shares always sum to one") {
    uint32_t state = 1;
    const auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / (1 << 24);
    };
    for (int trial = 0; trial < 20; ++trial) {
        Truth truth = truthOf(image(24, 17, [&](int, int) { return std::round(random() * 4) / 4; }), 24);
        for (PixelClass& kind : truth.classes)
            if (random() < 0.2f) kind = PixelClass::NoSurface;
        const Errors errors = errorsOf(image(24, 17, [&](int, int) { return random(); }), truth);
        CHECK(sum(errors.share) == Approx(1));
        for (const double share : errors.share) CHECK(share >= 0);
    }
}

TEST_CASE("flicker of the sequences of the algorithm notes") {
    struct Sequence {
        std::vector<float> shown, truth;
        double raw, compensated;
    };
    for (const Sequence& s : {Sequence{{0.5f, 0.52f, 0.49f, 0.51f, 0.5f}, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f}, 0.02, 0.02},
                              Sequence{{0, 0, 0.2f, 0.2f, 0.2f}, {0, 0, 0.2f, 0.2f, 0.2f}, 0.05, 0},
                              Sequence{{0, 0, 0.2f, 0.2f, 0.2f}, {0.1f, 0.1f, 0.1f, 0.1f, 0.1f}, 0.05, 0.05}}) {
        const Truth still = truthOf({0.0f}, 1);
        double raw = 0, compensated = 0;
        for (size_t i = 1; i < s.shown.size(); ++i) {
            const Truth before = truthOf({s.truth[i - 1]}, 1), now = truthOf({s.truth[i]}, 1);
            raw += flicker({{&s.shown[i - 1], 1}, &still}, {{&s.shown[i], 1}, &still}) / 4;
            compensated += flicker({{&s.shown[i - 1], 1}, &before}, {{&s.shown[i], 1}, &now}) / 4;
        }
        CHECK(raw == Approx(s.raw).margin(1e-7));
        CHECK(compensated == Approx(s.compensated).margin(1e-7));
    }
}

TEST_CASE("the figures of several frames together are those of all their pixels") {
    const Truth small = truthOf(Psi(16, 0.5f), 4), large = truthOf(Psi(64, 0.5f), 8);
    const std::vector<Errors> frames{errorsOf(Psi(16, 1.0f), small), errorsOf(Psi(64, 0.25f), large)};
    const Errors all = together(frames);
    CHECK(all.pixels == 80);
    CHECK(all.all.rmse == Approx(std::sqrt((16 * 0.25 + 64 * 0.0625) / 80)));
    CHECK(all.all.meanAbsolute == Approx((16 * 0.5 + 64 * 0.25) / 80));
    CHECK(all.all.bias == Approx((16 * 0.5 - 64 * 0.25) / 80));
    CHECK(all.all.max == 0.5);
    CHECK(all.all.p99 == Approx((0.5 + 0.25) / 2));
    CHECK(sum(all.share) == Approx(1));
}
