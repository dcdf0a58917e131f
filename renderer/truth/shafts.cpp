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

// The sides of a shaft. Inside a plane of light space, the sides touch the light at one end
// and the points at the other.
struct Shafts::Planes {
    static constexpr size_t lanes = 8;
    alignas(32) float x[lanes]{}, y[lanes]{}, z[lanes]{}; // unit normals, world
    alignas(32) float limit[lanes];                       // outside is what n·p is below; of no plane: −∞
    size_t count = 0;

    Planes(std::span<const glm::vec3> pointsWorld, const Target& target) {
        std::fill(std::begin(limit), std::end(limit), -infinity);
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
        const glm::vec4 row = planeLight * target.lightFromWorld;
        const glm::vec4 plane = row / glm::length(glm::vec3(row));
        x[count] = plane.x, y[count] = plane.y, z[count] = plane.z;
        // What is further out than rounding explains is outside.
        limit[count++] = -plane.w - margin(std::abs(plane.w));
    }

    // Without branches, so that the loops become vector code.
    bool misses(glm::vec3 low, glm::vec3 high) const {
        const glm::vec3 m = 0.5f * (low + high), r = 0.5f * (high - low);
        const float slack = margin(largest(glm::max(glm::abs(low), glm::abs(high))));
        int outside = 0;
        for (size_t i = 0; i < lanes; ++i) {
            const float most = x[i] * m.x + y[i] * m.y + z[i] * m.z + std::abs(x[i]) * r.x + std::abs(y[i]) * r.y +
                               std::abs(z[i]) * r.z;
            outside |= most + slack < limit[i] ? 1 : 0;
        }
        return outside != 0;
    }
    bool misses(const std::array<glm::vec3, 3>& v) const {
        const float slack = margin(std::max({largest(v[0]), largest(v[1]), largest(v[2])}));
        int outside = 0;
        for (size_t i = 0; i < lanes; ++i) {
            const float a = x[i] * v[0].x + y[i] * v[0].y + z[i] * v[0].z;
            const float b = x[i] * v[1].x + y[i] * v[1].y + z[i] * v[1].z;
            const float c = x[i] * v[2].x + y[i] * v[2].y + z[i] * v[2].z;
            const float ab = a > b ? a : b;
            outside |= (ab > c ? ab : c) + slack < limit[i] ? 1 : 0;
        }
        return outside != 0;
    }
};

namespace {

// A triangle that may be in the way.
struct Candidate {
    std::array<glm::vec3, 3> corners;
    glm::vec3 normal;  // unit, or 0 of one without area
    int lightSide = 0; // as side(), if all corners of the target are on the same one

    // Then no ray from the point crosses its plane.
    bool sameSide(glm::vec3 point) const { return lightSide != 0 && side(point) == lightSide; }

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

// Whether a plane through the point and an edge of the triangle has the triangle on one side, and the target on the other
// by more than rounding.
bool beside(glm::vec3 point, const Candidate& triangle, const Shafts::Target& target) {
    std::array<glm::vec3, 3> towards;
    for (size_t i = 0; i < 3; ++i) towards[i] = triangle.corners[i] - point;
    for (size_t i = 0; i < 3; ++i) {
        glm::vec3 m = glm::cross(towards[i], towards[(i + 1) % 3]);
        if (glm::dot(m, towards[(i + 2) % 3]) < 0) m = -m;
        const float slack = 1e-5f * glm::length(m);
        if (std::all_of(target.cornersWorld.begin(), target.cornersWorld.end(), [&](const glm::vec4& corner) {
                const glm::vec3 ray = glm::vec3(corner) - corner.w * point;
                return glm::dot(m, ray) < -slack * glm::length(ray);
            }))
            return true;
    }
    return false;
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
            Candidate candidate{v, length > 0 ? n / length : glm::vec3(0)};
            candidate.lightSide = sideOf(target, candidate);
            if (std::all_of(points.begin(), points.end(), [&](glm::vec3 p) { return candidate.sameSide(p); })) continue;
            if (found.size() == most) return false;
            found.push_back(candidate);
        }
    }
    return true;
}

void Shafts::look(std::span<const glm::vec3> points, const Target& target, std::span<uint8_t> sees) const {
    std::fill(sees.begin(), sees.end(), uint8_t(0));
    if (points.empty()) return;
    Candidates candidates;
    if (!gather(points, target, candidates)) {
        if (points.size() == 1) return;
        const size_t half = points.size() / 2;
        look(points.first(half), target, sees.first(half));
        look(points.subspan(half), target, sees.subspan(half));
        return;
    }
    for (size_t i = 0; i < points.size(); ++i) {
        const Planes planes(points.subspan(i, 1), target);
        sees[i] = std::all_of(candidates.begin(), candidates.end(), [&](const Candidate& triangle) {
            return triangle.sameSide(points[i]) || planes.misses(triangle.corners) ||
                   beside(points[i], triangle, target);
        });
    }
}

} // namespace penumbra
