// SPDX-License-Identifier: MIT
#include "renderer/truth/shafts.h"

#include "renderer/core/fixed_vector.h"

#include <algorithm>
#include <limits>

namespace penumbra {
namespace {

constexpr uint32_t leaf = 4; // triangles of a box without boxes
constexpr float infinity = std::numeric_limits<float>::infinity();

float largest(glm::vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Distances come of four products of coordinates and unit normals, each rounded to 2^-24 of it.
float margin(float coordinate) { return coordinate * 0x1p-21f; }

} // namespace

Shafts::Shafts(const std::vector<glm::vec3>& positionsWorld, std::vector<Triangle> triangles)
    : positions_(positionsWorld)
    , triangles_(std::move(triangles)) {
    if (triangles_.empty()) return;
    boxes_.reserve(triangles_.size());
    boxes_.emplace_back();
    build(0, 0, static_cast<uint32_t>(triangles_.size()));
}

// Halves the triangles at the median of their middles along the longest side.
void Shafts::build(uint32_t box, uint32_t first, uint32_t count) {
    const auto begin = triangles_.begin() + first, end = begin + count;
    const auto twiceMiddle = [&](const Triangle& t, int axis) {
        const float a = corner(t, 0)[axis], b = corner(t, 1)[axis], c = corner(t, 2)[axis];
        return std::min({a, b, c}) + std::max({a, b, c});
    };
    glm::vec3 low(infinity), high(-infinity);
    for (auto t = begin; t != end; ++t)
        for (size_t i = 0; i < 3; ++i) low = glm::min(low, corner(*t, i)), high = glm::max(high, corner(*t, i));
    boxes_[box] = {low, high, first, count};
    if (count <= leaf) return;
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = count / 2;
    std::nth_element(begin, begin + half, end, [&](const Triangle& a, const Triangle& b) {
        return twiceMiddle(a, axis) < twiceMiddle(b, axis);
    });
    const auto pair = static_cast<uint32_t>(boxes_.size());
    boxes_[box].first = pair, boxes_[box].count = 0;
    boxes_.resize(pair + 2);
    build(pair, first, half);
    build(pair + 1, first + half, count - half);
}

Shafts::Target::Target(const AreaLight& light)
    : lightFromWorld(penumbra::lightFromWorld(light))
    , half(halfSize(light))
    , directional(light.shape == LightShape::Directional) {
    const glm::mat4 worldFromLight = glm::inverse(lightFromWorld);
    for (size_t i = 0; i < 4; ++i) {
        const float x = i == 1 || i == 2 ? half.x : -half.x, y = i < 2 ? -half.y : half.y;
        cornersWorld[i] = worldFromLight * (directional ? glm::vec4(x, y, 1, 0) : glm::vec4(x, y, 0, 1));
    }
}

// The sides of a shaft, inside which n·p + d >= 0. Inside a plane of light space, the sides touch the light at one end
// and the points at the other.
struct Shafts::Planes {
    std::array<glm::vec4, 6> planes; // world; unit normals
    size_t count = 0;

    Planes(std::span<const glm::vec3> pointsWorld, const Target& target) {
        constexpr float far = infinity;
        glm::vec2 least(far), most(-far);
        float nearest = far, farthest = -far;
        for (const glm::vec3& world : pointsWorld) {
            const glm::vec3 p = glm::vec3(target.lightFromWorld * glm::vec4(world, 1));
            // Positional: slopes, over the depth −z, from the light's lower side down to the point and from its upper
            // one. Directional: where the outermost rays through the point meet z = 0.
            const glm::vec2 low = target.directional ? glm::vec2(p) + target.half * p.z
                                                     : (glm::vec2(p) + target.half) / -p.z;
            const glm::vec2 high = target.directional ? glm::vec2(p) - target.half * p.z
                                                      : (glm::vec2(p) - target.half) / -p.z;
            least = glm::min(least, low), most = glm::max(most, high);
            nearest = std::min(nearest, p.z), farthest = std::max(farthest, p.z);
        }
        for (int axis = 0; axis < 2; ++axis) {
            glm::vec4 low(0), high(0); // light space
            low[axis] = 1, high[axis] = -1;
            if (target.directional) {
                // Towards the light x grows by at most half.x over z: x >= least − half z, x <= most + half z.
                low.z = high.z = target.half[axis];
                low.w = -least[axis], high.w = most[axis];
            } else {
                // With depth −z: x + half − least depth >= 0, and half − x + most depth >= 0.
                low.z = least[axis], high.z = -most[axis];
                low.w = high.w = target.half[axis];
            }
            add(low, target), add(high, target);
        }
        add({0, 0, 1, -nearest}, target);
        if (!target.directional) add({0, 0, -1, 0}, target);
    }
    void add(glm::vec4 planeLight, const Target& target) {
        const glm::vec4 plane = planeLight * target.lightFromWorld; // a row
        planes[count++] = plane / glm::length(glm::vec3(plane));
    }

    bool misses(glm::vec3 low, glm::vec3 high) const {
        const glm::vec3 middle = 0.5f * (low + high), reach = 0.5f * (high - low);
        const float slack = margin(largest(glm::max(glm::abs(low), glm::abs(high))));
        for (size_t i = 0; i < count; ++i) {
            const glm::vec3 n(planes[i]);
            if (glm::dot(n, middle) + planes[i].w + glm::dot(glm::abs(n), reach) <
                -slack - 0x1p-21f * std::abs(planes[i].w))
                return true;
        }
        return false;
    }
    bool misses(const std::array<glm::vec3, 3>& v) const {
        const float slack = margin(std::max({largest(v[0]), largest(v[1]), largest(v[2])}));
        for (size_t i = 0; i < count; ++i) {
            const glm::vec3 n(planes[i]);
            if (std::max({glm::dot(n, v[0]), glm::dot(n, v[1]), glm::dot(n, v[2])}) + planes[i].w <
                -slack - 0x1p-21f * std::abs(planes[i].w))
                return true;
        }
        return false;
    }
};

namespace {

// A triangle that may be in the way.
struct Candidate {
    std::array<glm::vec3, 3> corners;
    glm::vec3 normal; // unit, or 0 of one without area
    bool solid;
    int lightSide = 0; // as side(), if all corners of the target are on the same one

    // Which side of its plane: 1, −1, or 0 within rounding.
    int side(glm::vec3 p) const {
        const float distance = glm::dot(normal, p - corners[0]);
        const float slack = margin(std::max(largest(p), largest(corners[0])));
        return distance > slack ? 1 : distance < -slack ? -1 : 0;
    }
    int side(glm::vec4 target) const { // a point, or a direction: the side that it leads to
        if (target.w != 0) return side(glm::vec3(target));
        const float rise = glm::dot(normal, glm::vec3(target));
        const float slack = margin(largest(target));
        return rise > slack ? 1 : rise < -slack ? -1 : 0;
    }
};

int sideOf(const Shafts::Target& target, const Candidate& triangle) {
    const int first = triangle.side(target.cornersWorld[0]);
    return std::all_of(target.cornersWorld.begin() + 1, target.cornersWorld.end(),
                       [&](glm::vec4 c) { return triangle.side(c) == first; })
               ? first
               : 0;
}

// How the target lies, as seen from a point, to the planes through the point and the triangle's edges.
enum class Lies { Across, Inside, Outside };
Lies seenFrom(glm::vec3 point, const Candidate& triangle, const Shafts::Target& target) {
    std::array<glm::vec3, 3> towards;
    for (size_t i = 0; i < 3; ++i) towards[i] = triangle.corners[i] - point;
    const float before = std::abs(glm::dot(triangle.normal, towards[0]));
    bool inside = true;
    for (size_t i = 0; i < 3; ++i) {
        glm::vec3 m = glm::cross(towards[i], towards[(i + 1) % 3]);
        if (glm::dot(m, towards[(i + 2) % 3]) < 0) m = -m;
        const float length = glm::length(m);
        int within = 0, beyond = 0;
        for (const glm::vec4& corner : target.cornersWorld) {
            const glm::vec3 ray = glm::vec3(corner) - corner.w * point;
            const float distance = glm::dot(m, ray), slack = 1e-5f * length * glm::length(ray);
            within += distance > slack, beyond += distance < -slack;
            // Rays end shortly before the light.
            if (corner.w != 0 && before > (1 - 0x1p-14f) * std::abs(glm::dot(triangle.normal, ray))) inside = false;
        }
        if (beyond == 4) return Lies::Outside;
        if (within != 4) inside = false;
    }
    return inside ? Lies::Inside : Lies::Across;
}

} // namespace

struct Shafts::Candidates : FixedVector<Candidate, most> {};

// What lies within the shaft and has not all of it on one side, such as the surface that the points are on. False: it
// is too much.
bool Shafts::gather(std::span<const glm::vec3> points, const Target& target, Candidates& found) const {
    const Planes planes(points, target);
    FixedVector<uint32_t, 64> open; // one and a pair a level; medians make 64 levels of 2^32 triangles impossible
    if (!boxes_.empty()) open.push_back(0);
    for (size_t size = open.size(); size > 0; size = open.size()) {
        const Box box = boxes_[open[size - 1]];
        open.pop_back();
        if (planes.misses(box.low, box.high)) continue;
        if (box.count == 0) {
            open.push_back(box.first), open.push_back(box.first + 1);
            continue;
        }
        for (uint32_t i = box.first; i < box.first + box.count; ++i) {
            const Triangle& triangle = triangles_[i];
            const std::array<glm::vec3, 3> v{corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
            if (planes.misses(v)) continue;
            const glm::vec3 n = glm::cross(v[1] - v[0], v[2] - v[0]);
            const float length = glm::length(n);
            Candidate candidate{v, length > 0 ? n / length : glm::vec3(0), triangle.solid && length > 0};
            candidate.lightSide = sideOf(target, candidate);
            if (candidate.lightSide != 0 && std::all_of(points.begin(), points.end(), [&](glm::vec3 point) {
                    return candidate.side(point) == candidate.lightSide;
                }))
                continue;
            if (found.size() == most) return false;
            found.push_back(candidate);
        }
    }
    return true;
}

void Shafts::look(std::span<const glm::vec3> points, const Target& target, std::span<Sight> sights) const {
    std::fill(sights.begin(), sights.end(), Sight::Unknown);
    if (points.empty()) return;
    Candidates candidates;
    if (!gather(points, target, candidates)) {
        if (points.size() == 1) return;
        const size_t half = points.size() / 2;
        look(points.first(half), target, sights.first(half));
        look(points.subspan(half), target, sights.subspan(half));
        return;
    }
    for (size_t i = 0; i < points.size(); ++i) {
        const Planes planes(points.subspan(i, 1), target);
        bool free = true;
        for (const Candidate& triangle : candidates) {
            const int side = triangle.side(points[i]);
            if (side != 0 && side == triangle.lightSide) continue; // no ray crosses its plane
            if (planes.misses(triangle.corners)) continue;
            const Lies lies = seenFrom(points[i], triangle, target);
            if (lies == Lies::Outside) continue;
            free = false;
            if (lies == Lies::Inside && triangle.solid && side != 0 && side == -triangle.lightSide) {
                sights[i] = Sight::Nothing;
                break;
            }
        }
        if (free) sights[i] = Sight::Everything;
    }
}

} // namespace penumbra
