// SPDX-License-Identifier: MIT
#include "renderer/scene/closed_surface.h"

#include <algorithm>
#include <numeric>

namespace penumbra {
namespace {

// For each vertex that a triangle of the primitive uses, the lowest one at the same place. Many primitives may share a
// long list of vertices, of which each uses a few.
std::vector<uint32_t> welded(const Scene& scene, const Primitive& primitive) {
    const glm::vec3* positions = scene.positions.data() + primitive.firstVertex;
    std::vector<uint32_t> order, first(primitive.vertexCount);
    std::vector<bool> used(primitive.vertexCount);
    for (uint32_t i = 0; i < primitive.indexCount; ++i) used[scene.indices[primitive.firstIndex + i]] = true;
    for (uint32_t v = 0; v < primitive.vertexCount; ++v)
        if (used[v]) order.push_back(v);
    const auto less = [&](uint32_t a, uint32_t b) {
        const glm::vec3 &p = positions[a], &q = positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : a < b;
    };
    std::sort(order.begin(), order.end(), less);
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && positions[order[i]] == positions[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

} // namespace

bool isClosedSurface(const Scene& scene, const Primitive& primitive) {
    const std::vector<uint32_t> first = welded(scene, primitive);
    std::vector<uint32_t> parent(primitive.vertexCount); // of the connected parts
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };

    std::vector<uint64_t> edges; // the lower corner, the higher corner, and in the lowest bit the way it is run through
    edges.reserve(primitive.indexCount);
    const uint32_t* indices = scene.indices.data() + primitive.firstIndex;
    for (uint32_t i = 0; i < primitive.indexCount; i += 3) {
        const uint32_t corner[3] = {first[indices[i]], first[indices[i + 1]], first[indices[i + 2]]};
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue; // no area, no edge
        for (int e = 0; e < 3; ++e) {
            const uint64_t a = corner[e], b = corner[(e + 1) % 3];
            edges.push_back(std::min(a, b) << 33 | std::max(a, b) << 1 | (a < b ? 0 : 1));
            parent[root(static_cast<uint32_t>(a))] = root(static_cast<uint32_t>(b));
        }
    }
    std::sort(edges.begin(), edges.end());
    for (size_t i = 0; i < edges.size();) {
        int balance = 0;
        const uint64_t edge = edges[i] >> 1;
        for (; i < edges.size() && edges[i] >> 1 == edge; ++i) balance += edges[i] & 1 ? -1 : 1;
        if (balance != 0) return false;
    }

    // Six times the volume of each part, about the centre of the bounds so that little cancels.
    std::vector<double> volume(primitive.vertexCount, 0.0);
    const glm::dvec3 centre = primitive.bounds.centre();
    for (uint32_t i = 0; i < primitive.indexCount; i += 3) {
        const auto corner = [&](uint32_t k) {
            return glm::dvec3(scene.positions[primitive.firstVertex + indices[i + k]]) - centre;
        };
        volume[root(first[indices[i]])] += glm::dot(corner(0), glm::cross(corner(1), corner(2)));
    }
    for (const uint64_t edge : edges)
        if (volume[root(static_cast<uint32_t>(edge >> 33))] <= 0) return false;
    return !edges.empty();
}

bool mayShadeItself(const Scene& scene, const Primitive& primitive) {
    constexpr uint32_t most = 3 * 256; // corners
    if (primitive.indexCount > most) return true;
    const auto corner = [&](uint32_t i) {
        return glm::dvec3(scene.positions[primitive.firstVertex + scene.indices[primitive.firstIndex + i]]);
    };
    const double slack = 1e-5 * double(primitive.bounds.diagonal());
    for (uint32_t i = 0; i < primitive.indexCount; i += 3) {
        const glm::dvec3 a = corner(i), across = glm::cross(corner(i + 1) - a, corner(i + 2) - a);
        const double area = glm::length(across);
        if (area == 0) continue;
        for (uint32_t k = 0; k < primitive.indexCount; ++k) {
            const double above = glm::dot(corner(k) - a, across) / area;
            if (above > slack || (!primitive.closed && above < -slack)) return true;
        }
    }
    return false;
}

} // namespace penumbra
