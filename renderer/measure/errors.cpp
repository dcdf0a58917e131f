// SPDX-License-Identifier: MIT
#include "renderer/measure/errors.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra {
namespace {

constexpr float litBelow = 0.01f, darkAbove = 0.99f; // as Truth::isPenumbra
constexpr float fadeTolerance = 0.01f;

bool isCounted(const Truth& truth, size_t pixel) { return truth.classes[pixel] == PixelClass::FacesWholeLight; }
bool isLit(float psi) { return psi <= litBelow; }
bool isDark(float psi) { return psi >= darkAbove; }

// Differences of a set of pixels, put together in the order of the pixels, so that the sums are always the same.
class Differences {
public:
    void add(double e) {
        squares_ += e * e;
        sum_ += e;
        sizes_.push_back(static_cast<float>(std::abs(e)));
        absolutes_ += std::abs(e);
    }
    size_t count() const { return sizes_.size(); }
    double squares() const { return squares_; }
    ErrorFigures figures() { // once
        if (sizes_.empty()) return {};
        const auto n = static_cast<double>(sizes_.size());
        return {std::sqrt(squares_ / n), absolutes_ / n, sum_ / n, ranked(0.95), ranked(0.99), ranked(1)};
    }

private:
    double ranked(double share) {
        const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sizes_.size()) - 1e-9));
        const auto place = sizes_.begin() + static_cast<std::ptrdiff_t>(std::max<size_t>(rank, 1) - 1);
        std::nth_element(sizes_.begin(), place, sizes_.end());
        return *place;
    }
    double squares_ = 0, sum_ = 0, absolutes_ = 0;
    std::vector<float> sizes_;
};

// The 5x5 neighbourhood of a pixel, clipped at the picture's border.
template <int radius, class Visit> void forNeighbours(const Truth& truth, size_t pixel, Visit&& visit) {
    const int width = truth.width, x0 = static_cast<int>(pixel) % width, y0 = static_cast<int>(pixel) / width;
    for (int y = std::max(y0 - radius, 0); y <= std::min(y0 + radius, truth.height - 1); ++y)
        for (int x = std::max(x0 - radius, 0); x <= std::min(x0 + radius, width - 1); ++x)
            visit(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
}

float medianAround(std::span<const float> shadow, const Truth& truth, size_t pixel) {
    std::array<float, 25> values{};
    size_t count = 0;
    forNeighbours<2>(truth, pixel, [&](size_t p) {
        if (isCounted(truth, p)) values[count++] = shadow[p];
    });
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

// ψ with the noise taken away that a median takes away.
std::vector<float> withoutNoise(std::span<const float> shadow, const Truth& truth) {
    std::vector<float> smooth(shadow.begin(), shadow.end());
    for (size_t i = 0; i < shadow.size(); ++i) {
        if (!isCounted(truth, i) || shadow[i] == truth.psi[i]) continue;
        const float m = medianAround(shadow, truth, i);
        if (std::abs(m - truth.psi[i]) < std::abs(shadow[i] - truth.psi[i])) smooth[i] = m;
    }
    return smooth;
}

// The pixels on the outskirts of a shadow's edge, on its lit side or on its dark one; see ErrorKind.
class Fringe {
public:
    Fringe(std::span<const float> smooth, const Truth& truth, bool litSide)
        : smooth_(smooth)
        , truth_(truth)
        , litSide_(litSide)
        , reached_(smooth.size()) {
        for (size_t i = 0; i < smooth.size(); ++i)
            if (!isSide(i) && isCounted(truth, i)) spread(i);
        for (size_t next = 0; next < queue_.size(); ++next) spread(queue_[next]);
    }
    bool has(size_t pixel) const { return reached_[pixel]; }

private:
    bool isSide(size_t i) const {
        return isCounted(truth_, i) && (litSide_ ? isLit(truth_.psi[i]) : isDark(truth_.psi[i]));
    }
    // How much of a fringe there is: on the lit side ψ, on the dark side 1 − ψ.
    float strength(size_t i) const { return litSide_ ? smooth_[i] : 1 - smooth_[i]; }
    void spread(size_t from) {
        forNeighbours<1>(truth_, from, [&](size_t to) {
            if (reached_[to] || !isSide(to) || strength(to) >= 0.5f) return;
            if (strength(to) > strength(from) + fadeTolerance) return;
            reached_[to] = true;
            queue_.push_back(to);
        });
    }

    std::span<const float> smooth_;
    const Truth& truth_;
    bool litSide_;
    std::vector<bool> reached_;
    std::vector<size_t> queue_;
};

ErrorKind kindOf(float s, float truth, bool litFringe, bool darkFringe) {
    if (isLit(truth) && s > truth) return litFringe ? ErrorKind::Wide : ErrorKind::FalseShadow;
    if (isDark(truth) && s < truth) return darkFringe ? ErrorKind::Wide : ErrorKind::Leak;
    return std::abs(s - 0.5f) < std::abs(truth - 0.5f) ? ErrorKind::Wide : ErrorKind::Narrow;
}

std::array<double, errorKinds> sharesOf(std::span<const float> shadow, const Truth& truth, double squares) {
    std::array<double, errorKinds> share{};
    if (squares <= 0) return share;
    const std::vector<float> smooth = withoutNoise(shadow, truth);
    const Fringe lit(smooth, truth, true), dark(smooth, truth, false);
    const auto square = [](float a, float b) { return (double(a) - b) * (double(a) - b); };
    for (size_t i = 0; i < shadow.size(); ++i) {
        if (!isCounted(truth, i)) continue;
        const float t = truth.psi[i], s = smooth[i];
        const double rest = square(s, t);
        const ErrorKind kind = kindOf(s, t, lit.has(i), dark.has(i));
        share[static_cast<size_t>(kind)] += rest / squares;
        share[static_cast<size_t>(ErrorKind::Noise)] += (square(shadow[i], t) - rest) / squares;
    }
    return share;
}

void requireSize(std::span<const float> shadow, const Truth& truth) {
    ensure(shadow.size() == truth.psi.size() && shadow.size() == truth.classes.size() &&
               shadow.size() == static_cast<size_t>(truth.width) * static_cast<size_t>(truth.height),
           "a shadow image and its truth differ in size");
}

} // namespace

Errors errorsOf(std::span<const float> shadow, const Truth& truth) {
    requireSize(shadow, truth);
    Errors errors;
    Differences all, penumbra;
    for (size_t i = 0; i < shadow.size(); ++i) {
        if (truth.classes[i] == PixelClass::CutByHorizon) ++errors.cutByHorizon;
        if (!isCounted(truth, i)) continue;
        ++errors.pixels;
        const bool inPenumbra = truth.isPenumbra(i);
        if (inPenumbra) ++errors.penumbraPixels;
        if (!std::isfinite(shadow[i])) {
            ++errors.notFinite;
            continue;
        }
        const double e = double(shadow[i]) - double(truth.psi[i]);
        all.add(e);
        if (inPenumbra) penumbra.add(e);
    }
    errors.all = all.figures();
    errors.penumbra = penumbra.figures();
    if (errors.notFinite == 0) errors.share = sharesOf(shadow, truth, all.squares());
    return errors;
}

double flicker(const ShadowFrame& first, const ShadowFrame& second) {
    requireSize(first.shadow, *first.truth);
    requireSize(second.shadow, *second.truth);
    ensure(first.shadow.size() == second.shadow.size(), "consecutive frames differ in size");
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < first.shadow.size(); ++i) {
        if (!isCounted(*first.truth, i) || !isCounted(*second.truth, i)) continue;
        const double change =
            (double(second.shadow[i]) - second.truth->psi[i]) - (double(first.shadow[i]) - first.truth->psi[i]);
        sum += std::abs(change);
        ++count;
    }
    return count ? sum / static_cast<double>(count) : 0;
}

} // namespace penumbra
