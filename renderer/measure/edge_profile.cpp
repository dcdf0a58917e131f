// SPDX-License-Identifier: MIT
#include "renderer/measure/edge_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

// The four pixels around a point, and how far it is from the first to the others.
struct Neighbours {
    std::array<size_t, 4> pixels; // upper left, upper right, lower left, lower right
    glm::vec2 share;
    Neighbours(glm::ivec2 size, glm::vec2 place) {
        const glm::vec2 centred = glm::clamp(place - 0.5f, glm::vec2(0), glm::vec2(size - 1));
        const glm::ivec2 first(centred), last = glm::min(first + 1, size - 1);
        share = centred - glm::vec2(first);
        const auto at = [&](int x, int y) {
            return static_cast<size_t>(y) * static_cast<size_t>(size.x) + static_cast<size_t>(x);
        };
        pixels = {at(first.x, first.y), at(last.x, first.y), at(first.x, last.y), at(last.x, last.y)};
    }
    size_t nearest() const { return pixels[(share.x > 0.5f ? 1 : 0) + (share.y > 0.5f ? 2 : 0)]; }
    template <class Value> float mix(Value&& value) const {
        return glm::mix(glm::mix(value(pixels[0]), value(pixels[1]), share.x),
                        glm::mix(value(pixels[2]), value(pixels[3]), share.x), share.y);
    }
};

} // namespace

void sampleLine(std::span<const float> image, glm::ivec2 size, glm::vec2 from, glm::vec2 to, size_t count,
                std::vector<float>& profile) {
    profile.clear();
    for (size_t i = 0; i < count; ++i) {
        const float t = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0;
        profile.push_back(Neighbours(size, glm::mix(from, to, t)).mix([&](size_t pixel) { return image[pixel]; }));
    }
}

std::optional<EdgeWidth> edgeWidth(std::span<const float> profile) {
    struct Passage {
        double at;
        bool high; // of 90 percent, not of 10
    };
    std::optional<Passage> last;
    std::optional<EdgeWidth> best;
    double bestDistance = 0;
    const double middle = (static_cast<double>(profile.size()) - 1) / 2;
    const auto pass = [&](Passage passage) {
        if (last && last->high != passage.high) {
            const double distance = std::abs((last->at + passage.at) / 2 - middle);
            if (!best || distance < bestDistance) {
                best = passage.high ? EdgeWidth{last->at, passage.at} : EdgeWidth{passage.at, last->at};
                bestDistance = distance;
            }
        }
        last = passage;
    };
    for (size_t i = 1; i < profile.size(); ++i) {
        const double a = profile[i - 1], b = profile[i];
        const auto meet = [&](double level, bool high) {
            if ((a < level) != (b < level)) pass({static_cast<double>(i - 1) + (level - a) / (b - a), high});
        };
        const bool rising = b > a; // which level comes first
        meet(rising ? 0.1 : 0.9, !rising);
        meet(rising ? 0.9 : 0.1, rising);
    }
    return best;
}

std::optional<glm::vec3> surfaceWorld(const View& view, std::span<const float> depth, glm::vec2 place) {
    const Neighbours around(view.size, place);
    float eyeDepth = depth[around.nearest()];
    if (!(eyeDepth > 0)) return std::nullopt;
    if (std::all_of(around.pixels.begin(), around.pixels.end(), [&](size_t pixel) { return depth[pixel] > 0; }))
        eyeDepth = 1 / around.mix([&](size_t pixel) { return 1 / depth[pixel]; });
    const glm::vec2 fromBelow(place.x, static_cast<float>(view.size.y) - place.y);
    return view.eyeWorld + eyeDepth * (view.rayCorner + fromBelow.x * view.rayDx + fromBelow.y * view.rayDy);
}

// From pixel to pixel. Along a plane 1 / depth grows by the same amount at each step in one direction; on curved
// surfaces by about the same, at a fold as before it or as after it; over a silhouette by far more than just before and
// just after.
bool onOneSurface(const View& view, std::span<const float> depth, glm::vec2 from, glm::vec2 to) {
    constexpr float times = 3, noise = 0.002f; // of 1 / depth: lower bumps are of one surface
    const auto inverse = [&](glm::ivec2 pixel) {
        const glm::ivec2 p = glm::clamp(pixel, glm::ivec2(0), view.size - 1);
        return 1 / depth[static_cast<size_t>(p.y) * static_cast<size_t>(view.size.x) + static_cast<size_t>(p.x)];
    };
    const int steps = static_cast<int>(std::ceil(std::max(std::abs(to.x - from.x), std::abs(to.y - from.y))));
    glm::ivec2 last(glm::floor(from));
    for (int i = 1; i <= steps; ++i) {
        const glm::ivec2 pixel(
            glm::floor(glm::mix(from, to, static_cast<float>(i) / static_cast<float>(std::max(steps, 1)))));
        const glm::ivec2 step = pixel - last;
        const float here = inverse(last), growth = inverse(pixel) - here;
        const auto alike = [&](float other) { return growth * other > 0 ? std::abs(other) : 0.0f; };
        const float around =
            std::max(alike(here - inverse(last - step)), alike(inverse(pixel + step) - inverse(pixel)));
        if (!std::isfinite(growth) || std::abs(growth) > times * around + noise * here) return false;
        last = pixel;
    }
    return true;
}

} // namespace penumbra
