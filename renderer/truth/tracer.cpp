// SPDX-License-Identifier: MIT
// A pixel's rays go to points of truthReplicates Halton sequences, each shifted by random numbers of its own (Cranley
// and Patterson 1976). The replicates are independent, so that their spread tells the standard error of their mean,
// which no single sequence could tell of itself (Owen, Monte Carlo theory, methods and examples, 17.3).
#include "renderer/truth/tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra {
namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function" // what only the GPU calls
namespace glsl {
using glm::abs;
using glm::max;
using glm::normalize;
using glm::vec2;
using glm::vec3;
#include "shaders/lib/octahedral.glsl"
} // namespace glsl
#pragma GCC diagnostic pop

constexpr int lanes = 8;           // rays of a packet
constexpr uint32_t batch = 256;    // rays of a pixel that are sorted together, at most
constexpr uint32_t firstRays = 16; // of a pixel; numbers of rays are multiples of it
constexpr int tile = 8;            // pixels along a side
constexpr size_t piece = 64;       // points that a thread takes at once

uint64_t mixed(uint64_t x) { // finalisation of splitmix64 (Steele et al. 2014)
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

uint32_t roundedUp(uint32_t rays) { return (rays + firstRays - 1) / firstRays * firstRays; }

} // namespace

glm::vec3 positionWorld(const TruthInput& input, size_t pixel) {
    const View& view = input.view;
    const auto width = static_cast<size_t>(view.size.x);
    const float x = static_cast<float>(pixel % width) + 0.5f;
    const float y = static_cast<float>(view.size.y) - static_cast<float>(pixel / width) - 0.5f; // row 0 is the top
    return view.eyeWorld + input.depth[pixel] * (view.rayCorner + x * view.rayDx + y * view.rayDy);
}

glm::vec3 normalWorld(const TruthInput& input, size_t pixel) { return glsl::unitFromOctahedral(input.normal[pixel]); }

std::vector<PixelClass> classesOf(const TruthInput& input) {
    const glm::mat4 fromWorld = lightFromWorld(input.light);
    std::vector<PixelClass> classes(input.depth.size(), PixelClass::NoSurface);
    for (size_t i = 0; i < classes.size(); ++i)
        if (input.depth[i] > 0)
            classes[i] = classify(input.light, glm::vec3(fromWorld * glm::vec4(positionWorld(input, i), 1)),
                                  glm::mat3(fromWorld) * normalWorld(input, i));
    return classes;
}

PixelClass classify(const AreaLight& light, glm::vec3 p, glm::vec3 n) {
    // As shaders/resolve.glsl: n·(S − P), or n·l, is greatest and least over the light at its centre's ± spread.
    const glm::vec2 half = halfSize(light), reach = half * glm::vec2(n);
    const float spread =
        light.shape == LightShape::Rectangle ? std::abs(reach.x) + std::abs(reach.y) : glm::length(reach);
    const bool directional = light.shape == LightShape::Directional;
    const float centre = directional ? n.z : -glm::dot(n, p);
    if (centre + spread <= 0) return PixelClass::FacesAway;
    if (!directional && p.z >= 0) return PixelClass::BehindLight;
    return centre - spread > 0 ? PixelClass::FacesWholeLight : PixelClass::CutByHorizon;
}

// Where all replicates agree, their spread says nothing: N rays of one answer are N successes of an unknown chance,
// whose posterior deviation is about 1 / (N + 2) (Laplace's rule of succession). Between 0 and 1 it is the same order:
// each replicate knows its share to 1 / n, and that all eight fell on the same multiple leaves about a tenth of that.
Estimate estimateOf(const std::array<uint16_t, truthReplicates>& hidden, uint32_t rays) {
    if (rays == 0) return {0, 1};
    uint32_t sum = 0;
    uint64_t squares = 0;
    for (const uint32_t h : hidden) sum += h, squares += h * h;
    const float psi = static_cast<float>(sum) / static_cast<float>(rays);
    // Σ (h − mean)², times the number of replicates so that it is a whole number.
    const uint64_t deviation = squares * truthReplicates - uint64_t(sum) * sum;
    if (deviation == 0) return {psi, 1 / (static_cast<float>(rays) + 2)};
    // The root of an unbiased variance is too small on average, by c₄(8) = √(2/7) Γ(4) / Γ(7/2).
    constexpr double c4 = 0.9650304561;
    constexpr double k = truthReplicates;
    const double perReplicate = static_cast<double>(rays) / k;
    const double variance = static_cast<double>(deviation) / k / (k - 1) / k / (perReplicate * perReplicate);
    return {psi, static_cast<float>(std::sqrt(variance) / c4)};
}

Tracer::Tracer(const TruthInput& input, const TruthSettings& settings, const Casters& casters, Crew& crew)
    : input_(input)
    , settings_(settings)
    , casters_(casters)
    , crew_(crew) {
    const AreaLight& light = input.light;
    const glm::mat4 worldFromLight = glm::inverse(lightFromWorld(light));
    lightX_ = glm::vec3(worldFromLight[0]), lightY_ = glm::vec3(worldFromLight[1]);
    directional_ = light.shape == LightShape::Directional;
    round_ = light.shape != LightShape::Rectangle;
    lightCentre_ = directional_ ? glm::vec3(worldFromLight[2]) : light.position;
    halfLight_ = halfSize(light);
    truth_.width = input.view.size.x, truth_.height = input.view.size.y;
    const size_t pixels = static_cast<size_t>(truth_.width) * static_cast<size_t>(truth_.height);
    truth_.psi.resize(pixels);
    truth_.standardError.resize(pixels);
    truth_.classes = classesOf(input);
    findPoints();
    asked_ = points_.size();
    askOfBlocks();
}

size_t Tracer::blockOf(uint32_t pixel) const {
    const auto width = static_cast<uint32_t>(truth_.width);
    return size_t(pixel / width / 2) * ((width + 1) / 2) + pixel % width / 2;
}

// A few rays of one point in each block of 2x2 pixels, for a picture as soon as can be.
void Tracer::askOfBlocks() {
    constexpr uint32_t none = ~0u;
    pixelOfBlock_.assign(static_cast<size_t>((truth_.width + 1) / 2) * static_cast<size_t>((truth_.height + 1) / 2),
                         none);
    for (uint32_t i = 0; i < points_.size(); ++i) {
        uint32_t& pixel = pixelOfBlock_[blockOf(points_[i].pixel)];
        if (pixel != none) continue;
        pixel = points_[i].pixel;
        points_[i].wanted = firstRays;
        unfinished_.push_back(i);
    }
    raysForeseen_ = points_.size() * roundedUp(static_cast<uint32_t>(settings_.leastSamples));
}

// The least number of rays of every point.
void Tracer::askAll() {
    unfinished_.resize(points_.size());
    std::iota(unfinished_.begin(), unfinished_.end(), 0u);
    raysForeseen_ = raysTraced_;
    for (const Point& point : points_)
        raysForeseen_ += roundedUp(static_cast<uint32_t>(settings_.leastSamples)) - point.rays;
}

// Points in small squares of pixels, whose rays are near to each other.
void Tracer::findPoints() {
    const View& view = input_.view;
    const auto largest = [](glm::vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    const auto add = [&](uint32_t pixel) {
        const PixelClass kind = truth_.classes[pixel];
        if (kind == PixelClass::FacesAway) truth_.psi[pixel] = 1;
        if (kind != PixelClass::FacesWholeLight && kind != PixelClass::CutByHorizon) return;

        // The point must lie above its triangle for every way in which it may be off:
        //   depth: the rasteriser places vertices on a grid of 1/256 of a pixel, so that the plane is met up to half a
        //     step to the side: footprint / 512 at right angles to the ray, never more along the normal; doubled
        //   rounding of the position: eye, depth·ray and their sum, half a unit in the last place (2^-24) each; the
        //     depth itself comes of a handful of operations; so do the vertices, posed and as Embree subtracts the
        //     origin from them: 16 roundings of the largest coordinate in play, 2^-20
        const glm::vec3 position = positionWorld(input_, pixel), normal = normalWorld(input_, pixel);
        const float footprint = input_.depth[pixel] * glm::length(view.rayDy);
        const float coordinate =
            std::max({largest(position), largest(view.eyeWorld), glm::distance(position, view.eyeWorld)});
        const float offset = footprint / 256 + coordinate * 0x1p-20f;
        points_.push_back(
            {position + offset * normal, kind == PixelClass::CutByHorizon ? normal : glm::vec3(0), pixel});
    };
    const int width = truth_.width, height = truth_.height;
    for (int top = 0; top < height; top += tile)
        for (int left = 0; left < width; left += tile) {
            squares_.push_back(static_cast<uint32_t>(points_.size()));
            for (int y = top; y < std::min(top + tile, height); ++y)
                for (int x = left; x < std::min(left + tile, width); ++x) add(static_cast<uint32_t>(y * width + x));
        }
    squares_.push_back(static_cast<uint32_t>(points_.size()));
}

// Of the points whose rays, or their neighbour's, all found the light so far, those of which every ray would. Of those
// whose rays all hit something it does not pay to know more: their rays end soon.
void Tracer::dropCertain() {
    const Shafts::Target target(input_.light);
    std::vector<uint8_t> sees(points_.size());
    crew_.shareOut(squares_.size() - 1, 16, [&](size_t begin, size_t end) {
        std::array<glm::vec3, tile * tile> origins;
        std::array<uint8_t, tile * tile> seesAll;
        std::array<uint32_t, tile * tile> points;
        for (size_t square = begin; square < end; ++square) {
            size_t count = 0;
            for (uint32_t i = squares_[square]; i < squares_[square + 1]; ++i)
                if (const uint32_t pixel = points_[i].pixel;
                    truth_.psi[pixel] == 0 && truth_.classes[pixel] == PixelClass::FacesWholeLight)
                    points[count] = i, origins[count++] = points_[i].originWorld;
            casters_.shafts().look(std::span(origins).first(count), target, std::span(seesAll).first(count));
            for (size_t k = 0; k < count; ++k) sees[points[k]] = seesAll[k];
        }
    });
    size_t kept = 0;
    for (size_t i = 0; i < points_.size(); ++i) {
        if (sees[i])
            truth_.standardError[points_[i].pixel] = 0;
        else
            points_[kept++] = points_[i];
    }
    points_.erase(points_.begin() + static_cast<ptrdiff_t>(kept), points_.end());
}

namespace {

// Points of the light to which rays of one pixel go together, each coordinate in [-1, 1]: the replicates of one point
// of the sequence, then those of the next.
struct Aims {
    alignas(64) float x[batch], y[batch];
    uint8_t order[batch];
};

template <bool round> inline void shiftPoints(const float* haltonX, const float* haltonY, const float* shiftX,
                                              const float* shiftY, uint32_t count, float* __restrict x,
                                              float* __restrict y) {
    for (uint32_t i = 0; i < count; i += truthReplicates)
        for (uint32_t k = 0; k < truthReplicates; ++k)
            x[i + k] = haltonX[i / truthReplicates] + shiftX[k], y[i + k] = haltonY[i / truthReplicates] + shiftY[k];
    for (uint32_t i = 0; i < count; ++i) {
        PlanePoint p{2 * (x[i] - (x[i] >= 1 ? 1.0f : 0.0f)) - 1, 2 * (y[i] - (y[i] >= 1 ? 1.0f : 0.0f)) - 1};
        if constexpr (round) p = concentricDisk(p); // as scene/light.h's lightPoint() has it
        x[i] = p.x, y[i] = p.y;
    }
}

// Compiled for eight lanes at once too, for processors that have them. The results are the same to the last bit. The
// sanitizers start later than the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE_TOO __attribute__((target_clones("avx2", "default")))
#else
#define WIDE_TOO
#endif
WIDE_TOO void shiftOnRectangle(const float* haltonX, const float* haltonY, const float* shiftX, const float* shiftY,
                               uint32_t count, Aims& aims) {
    shiftPoints<false>(haltonX, haltonY, shiftX, shiftY, count, aims.x, aims.y);
}
WIDE_TOO void shiftOnDisk(const float* haltonX, const float* haltonY, const float* shiftX, const float* shiftY,
                          uint32_t count, Aims& aims) {
    shiftPoints<true>(haltonX, haltonY, shiftX, shiftY, count, aims.x, aims.y);
}

// Orders the first `count` by the cells of a grid, along a curve that fills the light: a packet of rays to near points
// meets the same boxes of the hierarchy.
void sortPoints(uint32_t count, Aims& aims) {
    constexpr uint32_t side = 8;
    constexpr uint8_t spread[side] = {0, 1, 4, 5, 16, 17, 20, 21}; // the bits of a coordinate, with a gap behind each
    uint8_t cell[batch];
    uint16_t next[side * side + 1] = {};
    for (uint32_t i = 0; i < count; ++i) {
        const auto x = std::min(static_cast<uint32_t>((aims.x[i] + 1) * (side / 2)), side - 1);
        const auto y = std::min(static_cast<uint32_t>((aims.y[i] + 1) * (side / 2)), side - 1);
        cell[i] = static_cast<uint8_t>(spread[x] | spread[y] << 1);
        ++next[cell[i] + 1];
    }
    for (uint32_t c = 0; c < side * side; ++c) next[c + 1] = static_cast<uint16_t>(next[c + 1] + next[c]);
    for (uint32_t i = 0; i < count; ++i) aims.order[next[cell[i]]++] = static_cast<uint8_t>(i);
}

} // namespace

// The rays of one pixel up to point.wanted.
void Tracer::trace(Point& point) const {
    const glm::vec3 o = point.originWorld, n = point.normalWorld;
    const bool cut = n != glm::vec3(0);
    const glm::vec3 centre = directional_ ? lightCentre_ : lightCentre_ - o;
    const glm::vec3 sideX = lightX_ * halfLight_.x, sideY = lightY_ * halfLight_.y;
    // What lies in the plane of the light itself, such as the pane of a lamp, is not before it.
    const float farthest = directional_ ? std::numeric_limits<float>::infinity() : 1 - 0x1p-16f;
    float shiftX[truthReplicates], shiftY[truthReplicates];
    for (size_t i = 0; i < truthReplicates; ++i) {
        const uint64_t bits = mixed(mixed(input_.seed * truthReplicates + i) + point.pixel);
        shiftX[i] = static_cast<float>(bits >> 40) * 0x1p-24f;
        shiftY[i] = static_cast<float>(bits >> 16 & 0xffffff) * 0x1p-24f;
    }
    RTCRay8 rays;
    alignas(32) int valid[lanes];
    for (int i = 0; i < lanes; ++i) {
        rays.org_x[i] = o.x, rays.org_y[i] = o.y, rays.org_z[i] = o.z;
        rays.tnear[i] = rays.time[i] = 0;
        rays.mask[i] = ~0u, rays.id[i] = rays.flags[i] = 0;
        valid[i] = -1;
    }

    Aims aims;
    while (point.rays < point.wanted) {
        const uint32_t count = std::min(point.wanted - point.rays, batch), first = point.rays / truthReplicates;
        (round_ ? shiftOnDisk : shiftOnRectangle)(haltonX_.data() + first, haltonY_.data() + first, shiftX, shiftY,
                                                  count, aims);
        sortPoints(count, aims);
        for (uint32_t packet = 0; packet < count; packet += lanes) {
            const uint8_t* order = aims.order + packet;
            alignas(32) float x[lanes], y[lanes];
            for (int i = 0; i < lanes; ++i) x[i] = aims.x[order[i]], y[i] = aims.y[order[i]];
            for (int i = 0; i < lanes; ++i) {
                rays.dir_x[i] = centre.x + x[i] * sideX.x + y[i] * sideY.x;
                rays.dir_y[i] = centre.y + x[i] * sideX.y + y[i] * sideY.y;
                rays.dir_z[i] = centre.z + x[i] * sideX.z + y[i] * sideY.z;
                rays.tfar[i] = farthest;
                if (cut) valid[i] = n.x * rays.dir_x[i] + n.y * rays.dir_y[i] + n.z * rays.dir_z[i] > 0 ? -1 : 0;
            }
            casters_.occluded(valid, rays);
            for (int i = 0; i < lanes; ++i)
                point.hidden[order[i] % truthReplicates] += valid[i] == 0 || rays.tfar[i] < 0 ? 1 : 0;
        }
        point.rays += count;
    }
}

bool Tracer::next(Progress* progress) {
    if (!plan()) return false;
    uint32_t most = 0;
    for (const uint32_t i : unfinished_) most = std::max(most, points_[i].wanted);
    for (uint32_t i = static_cast<uint32_t>(haltonX_.size()); i < most / truthReplicates; ++i) {
        const glm::vec2 u = haltonPoint(i);
        haltonX_.push_back(u.x), haltonY_.push_back(u.y);
    }
    if (progress) progress->report("tracing rays", shareDone(raysTraced_));
    std::atomic<uint64_t> traced{0};
    crew_.shareOut(unfinished_.size(), piece, [&](size_t begin, size_t end) {
        if (progress && progress->cancelled()) return;
        uint64_t rays = 0;
        for (size_t i = begin; i < end; ++i) {
            Point& point = points_[unfinished_[i]];
            rays += point.wanted - point.rays;
            trace(point);
        }
        const uint64_t now = traced += rays;
        if (progress) progress->note(shareDone(raysTraced_ + now));
    });
    raysTraced_ += traced;
    if (progress) progress->report("tracing rays", shareDone(raysTraced_));
    estimate();
    return true;
}

double Tracer::shareDone(uint64_t rays) const {
    return raysForeseen_ == 0 ? 1 : static_cast<double>(rays) / static_cast<double>(std::max(raysForeseen_, rays));
}

void Tracer::estimate() {
    crew_.shareOut(points_.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Point& point = points_[i];
            const Estimate found = estimateOf(point.hidden, point.rays);
            truth_.psi[point.pixel] = found.psi;
            truth_.standardError[point.pixel] = found.standardError;
        }
    });
    if (raysOfAll_ == 0)
        for (const Point& point : points_)
            if (point.rays == 0) truth_.psi[point.pixel] = truth_.psi[pixelOfBlock_[blockOf(point.pixel)]];
    truth_.samplesLeast = truth_.samplesMost = points_.empty() ? 0 : static_cast<int>(points_[0].rays);
    double errors = 0;
    truth_.penumbraPixels = 0;
    for (const Point& point : points_) {
        truth_.samplesLeast = std::min(truth_.samplesLeast, static_cast<int>(point.rays));
        truth_.samplesMost = std::max(truth_.samplesMost, static_cast<int>(point.rays));
        if (!truth_.isPenumbra(point.pixel)) continue;
        errors += truth_.standardError[point.pixel];
        ++truth_.penumbraPixels;
    }
    truth_.samplesMean = asked_ == 0 ? 0 : static_cast<double>(raysTraced_) / static_cast<double>(asked_);
    truth_.meanPenumbraStandardError = truth_.penumbraPixels ? errors / truth_.penumbraPixels : 0;
}

// Decides how many rays each pixel gets this round. A quarter get 16; then all that shafts leave get 64, and what is
// left to the least number at once, as many rays of a pixel are cheaper together. Then those get more whose standard
// error is above the wanted one. It is judged by the mean variance of the 3x3 pixels around: that of one pixel's eight
// replicates is itself so uncertain that those which seem good by chance would be left alone; and a pixel whose rays
// all agree beside one whose rays do not is not certain.
bool Tracer::plan() {
    const auto least = roundedUp(static_cast<uint32_t>(settings_.leastSamples));
    const auto most = std::max(least, roundedUp(static_cast<uint32_t>(settings_.mostSamples)));
    if (points_.empty()) return false;
    if (raysTraced_ == 0) return true; // the constructor has asked
    if (raysOfAll_ < least) {
        if (raysOfAll_ == 0 && settings_.shafts) dropCertain();
        askAll();
        if (points_.empty()) return false;
        raysOfAll_ = raysOfAll_ == 0 ? std::min(4 * firstRays, least) : std::min(raysOfAll_ + batch, least);
        for (Point& point : points_) point.wanted = raysOfAll_;
        return true;
    }
    unfinished_.clear();
    const double wanted = settings_.wantedStandardError;
    if (truth_.meanPenumbraStandardError < wanted || least == most) return false;

    // The error of n points falls about as n^-3/4 (a discontinuity in two dimensions), so the variance times n^3/2 is
    // the pixel's own and can be averaged over pixels of different n.
    const int width = truth_.width, height = truth_.height;
    std::atomic<uint64_t> foreseen{0};
    spread_.assign(truth_.psi.size(), -1);
    crew_.shareOut(points_.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Point& point = points_[i];
            const float psi = truth_.psi[point.pixel], error = truth_.standardError[point.pixel];
            const bool unanimous = psi == 0 || psi == 1;
            spread_[point.pixel] = unanimous ? 0 : error * error * std::pow(static_cast<float>(point.rays), 1.5f);
        }
    });
    crew_.shareOut(points_.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Point& point = points_[i];
            const int x = static_cast<int>(point.pixel) % width, y = static_cast<int>(point.pixel) / width;
            float sum = 0, count = 0;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                    const float s =
                        spread_[static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u)];
                    if (s >= 0) sum += s, ++count;
                }
            // variance = spread n^-3/2 = wanted²
            const double enough = std::pow(static_cast<double>(sum / count) / (wanted * wanted), 1 / 1.5);
            const double now = point.rays;
            if (enough <= now || point.rays >= most) continue;
            point.wanted = std::min(most, roundedUp(static_cast<uint32_t>(std::min(enough, 2 * now))));
            foreseen += static_cast<uint64_t>(std::min(enough, static_cast<double>(most)) - now);
        }
    });
    raysForeseen_ = raysTraced_ + foreseen;
    for (uint32_t i = 0; i < points_.size(); ++i)
        if (points_[i].wanted > points_[i].rays) unfinished_.push_back(i);
    return !unfinished_.empty();
}

} // namespace penumbra
