// SPDX-License-Identifier: MIT
#include "renderer/scene/part_bounds.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace penumbra {
namespace {

constexpr size_t fewTriangles = 64; // are not divided
constexpr int mostDivisions = 6;    // of a primitive, one after the other: 2^6 parts

struct Divider {
    const Scene& scene;
    const Primitive& primitive;
    std::vector<Bounds> parts{};

    glm::vec3 position(uint32_t triangle, uint32_t corner) const {
        return scene.positions[primitive.firstVertex + scene.indices[primitive.firstIndex + 3 * triangle + corner]];
    }
    // In halves of as many triangles each, across the longest side of what holds their middles.
    void divide(std::span<uint32_t> triangles, int divisions) {
        Bounds all, middles;
        const auto middle = [&](uint32_t t) { return position(t, 0) + position(t, 1) + position(t, 2); };
        for (const uint32_t t : triangles) {
            for (uint32_t corner = 0; corner < 3; ++corner) all.add(position(t, corner));
            middles.add(middle(t));
        }
        if (triangles.size() <= fewTriangles || divisions == 0) {
            parts.push_back(all);
            return;
        }
        const glm::vec3 extent = middles.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const size_t half = triangles.size() / 2;
        std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                         [&](uint32_t a, uint32_t b) { return middle(a)[axis] < middle(b)[axis]; });
        divide(triangles.first(half), divisions - 1);
        divide(triangles.subspan(half), divisions - 1);
    }
};

} // namespace

std::vector<Bounds> partBounds(const Scene& scene, const Primitive& primitive) {
    std::vector<uint32_t> triangles(primitive.indexCount / 3);
    std::iota(triangles.begin(), triangles.end(), 0u);
    Divider divider{scene, primitive};
    divider.divide(triangles, mostDivisions);
    if (divider.parts.size() == 1) divider.parts.clear();
    return std::move(divider.parts);
}

} // namespace penumbra
