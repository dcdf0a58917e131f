// SPDX-License-Identifier: MIT
// Cameras, lights and ground: the scene's own, or ones made from its bounds.
#include "renderer/scene/posing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra {
namespace {

// Of a scene without anything in it, a metre's cube on the origin stands in.
Bounds boundsOrUnit(const Scene& scene, const Pose& pose) {
    Bounds bounds = worldBounds(scene, pose);
    if (bounds.diagonal() > 0) return bounds;
    const glm::vec3 centre = bounds.empty() ? glm::vec3(0, 0.5f, 0) : bounds.centre();
    return {centre - 0.5f, centre + 0.5f};
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
}

glm::vec3 forwardOf(const glm::mat4& worldFromNode) { return unitOr(-glm::vec3(worldFromNode[2]), {0, 0, -1}); }

// Where a ray enters and leaves the bounds, from its origin on, in lengths of the direction.
std::optional<std::pair<float, float>> passage(const Bounds& bounds, const glm::vec3& origin,
                                               const glm::vec3& direction) {
    float enter = 0, leave = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < bounds.min[axis] || origin[axis] > bounds.max[axis]) return std::nullopt;
            continue;
        }
        const float a = (bounds.min[axis] - origin[axis]) / direction[axis];
        const float b = (bounds.max[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (leave < enter) return std::nullopt;
    return std::pair(enter, leave);
}

// How far along the ray its last point inside the bounds is; if it misses them, how far the centre is along it.
float reach(const Bounds& bounds, const glm::vec3& origin, const glm::vec3& direction) {
    const float diagonal = bounds.diagonal();
    if (const auto inside = passage(bounds, origin, direction); inside && inside->second > 1e-3f * diagonal)
        return inside->second;
    const float toCentre = glm::dot(bounds.centre() - origin, direction);
    return toCentre > 1e-3f * diagonal ? toCentre : 0.5f * diagonal;
}

// How far along the ray a triangle is (Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997).
std::optional<float> triangleDistance(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3& a,
                                      const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac), from = origin - a;
    const float determinant = glm::dot(ab, p);
    if (determinant == 0) return std::nullopt;
    const glm::vec3 q = glm::cross(from, ab);
    const float u = glm::dot(from, p) / determinant, v = glm::dot(direction, q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return std::nullopt;
    return glm::dot(ac, q) / determinant;
}

// How far along the ray the scene's nearest surface is, beyond `nearest`.
std::optional<float> surfaceDistance(const Scene& scene, const Pose& pose, const glm::vec3& origin,
                                     const glm::vec3& direction, float nearest) {
    std::optional<float> found;
    std::vector<glm::vec3> positionsWorld;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
            const auto inside = passage(posedBounds(scene, pose, n, primitive), origin, direction);
            if (!inside || (found && inside->first > *found)) continue;
            posedPositions(scene, pose, n, primitive, positionsWorld);
            const uint32_t* corner = scene.indices.data() + primitive.firstIndex;
            for (const uint32_t* last = corner + primitive.indexCount; corner < last; corner += 3) {
                const auto distance = triangleDistance(origin, direction, positionsWorld[corner[0]],
                                                       positionsWorld[corner[1]], positionsWorld[corner[2]]);
                if (distance && *distance > nearest && (!found || *distance < *found)) found = distance;
            }
        }
    }
    return found;
}

// How far away the point is that a camera turns about: the surface in the middle of its picture, or where there is
// none the depth of the scene's centre.
float sightDistance(const Scene& scene, const Pose& pose, const Bounds& bounds, const glm::vec3& origin,
                    const glm::vec3& direction) {
    const float diagonal = bounds.diagonal();
    if (const auto surface = surfaceDistance(scene, pose, origin, direction, 1e-3f * diagonal)) return *surface;
    const float distance = glm::dot(bounds.centre() - origin, direction);
    return distance > 0.05f * diagonal ? distance : 0.25f * diagonal;
}

} // namespace

Camera sceneCamera(const Scene& scene, const Pose& pose, const NamedCamera& named) {
    const glm::mat4& worldFromNode = pose.worldFromNode[size_t(named.node)];
    const Bounds bounds = boundsOrUnit(scene, pose);
    const glm::vec3 forward = forwardOf(worldFromNode);
    const glm::vec3 upright = unitOr(glm::vec3(worldFromNode[1]), {0, 1, 0});

    Camera camera;
    camera.eye = glm::vec3(worldFromNode[3]);
    camera.fovY = named.fovY;
    // An upright camera gets world +Y, about which it can be turned.
    const bool rolled = std::abs(glm::cross(forward, upright).y) > 1e-3f || upright.y <= 0;
    camera.up = rolled ? upright : glm::vec3(0, 1, 0);
    if (named.halfHeight > 0) {
        // Parallel rays have no eye: one is put where 30 degrees show as much at the centre of the scene.
        camera.fovY = 30;
        const float distance = named.halfHeight / std::tan(0.5f * glm::radians(camera.fovY));
        camera.target = camera.eye + forward * glm::dot(bounds.centre() - camera.eye, forward);
        camera.eye = camera.target - forward * distance;
        return camera;
    }
    camera.target = camera.eye + forward * sightDistance(scene, pose, bounds, camera.eye, forward);
    return camera;
}

AreaLight sceneLight(const Scene& scene, const Pose& pose, const NamedLight& named) {
    const glm::mat4& worldFromNode = pose.worldFromNode[size_t(named.node)];
    const Bounds bounds = boundsOrUnit(scene, pose);
    AreaLight light;
    light.shape = named.shape;
    light.colour = named.colour;
    light.position = glm::vec3(worldFromNode[3]);
    glm::vec3 forward = forwardOf(worldFromNode);
    if (named.shape == LightShape::Directional) {
        light.size = named.size.x > 0 ? named.size : glm::vec2(2);
        light.target = bounds.centre();
        light.position = light.target - forward * bounds.diagonal();
        return light;
    }
    if (named.everywhere) forward = unitOr(bounds.centre() - light.position, {0, -1, 0});
    light.size = named.size.x > 0 ? named.size : glm::vec2(bounds.diagonal() / 20);
    light.target = light.position + forward * reach(bounds, light.position, forward);
    return light;
}

Camera defaultCamera(const Scene& scene, const Pose& pose) {
    if (!scene.cameras.empty()) return sceneCamera(scene, pose, scene.cameras.front());
    const Bounds bounds = boundsOrUnit(scene, pose);
    Camera camera;
    camera.target = bounds.centre();
    // The ball around the bounds just fits into the view.
    const float distance = 0.5f * bounds.diagonal() / std::sin(0.5f * glm::radians(camera.fovY));
    camera.eye = camera.target + distance * glm::normalize(glm::vec3(0.7f, 0.6f, 1.0f));
    return camera;
}

AreaLight defaultLight(const Scene& scene, const Pose& pose) {
    if (!scene.lights.empty()) return sceneLight(scene, pose, scene.lights.front());
    const Bounds bounds = boundsOrUnit(scene, pose);
    AreaLight light;
    light.target = bounds.centre();
    light.position = light.target + 1.2f * bounds.diagonal() * glm::normalize(glm::vec3(-0.5f, 1.0f, 0.35f));
    light.size = glm::vec2(bounds.diagonal() / 10);
    return light;
}

Ground groundBelow(const Scene& scene, const Pose& pose) {
    const Bounds bounds = boundsOrUnit(scene, pose);
    const glm::vec3 centre = bounds.centre();
    return {.height = bounds.min.y, .centre = {centre.x, centre.z}, .halfSize = 3 * bounds.diagonal()};
}

// Looks for a floor: surfaces that face up in the lowest quarter of the scene and, seen from above, fill half of it.
// What stands tall on it throws its shadow beyond, so the scene must also be broad.
bool wantsGround(const Scene& scene, const Pose& pose) {
    const Bounds bounds = worldBounds(scene, pose);
    if (bounds.empty()) return false;
    const glm::vec3 extent = bounds.extent();
    constexpr float tallest = 0.6f; // of the smaller width
    if (!(extent.y <= tallest * std::min(extent.x, extent.z))) return true;

    constexpr int cells = 24; // along each side of the bounds
    const float highest = bounds.min.y + 0.25f * extent.y;
    std::vector<bool> covered(cells * cells);
    const auto cover = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        // In units of cells, centres at whole numbers.
        const auto onGrid = [&](const glm::vec3& p) {
            return glm::vec2((p.x - bounds.min.x) / extent.x, (p.z - bounds.min.z) / extent.z) * float(cells) - 0.5f;
        };
        const glm::vec2 p = onGrid(a), q = onGrid(b), r = onGrid(c);
        const auto first = [](float v) { return std::max(0, int(std::ceil(v - 1e-3f))); };
        const auto last = [&](float v) { return std::min(cells - 1, int(std::floor(v + 1e-3f))); };
        const auto side = [](glm::vec2 from, glm::vec2 to, glm::vec2 x) {
            return (to.x - from.x) * (x.y - from.y) - (to.y - from.y) * (x.x - from.x);
        };
        const float slack = 1e-3f;
        for (int j = first(std::min({p.y, q.y, r.y})); j <= last(std::max({p.y, q.y, r.y})); ++j)
            for (int i = first(std::min({p.x, q.x, r.x})); i <= last(std::max({p.x, q.x, r.x})); ++i) {
                const glm::vec2 x(i, j);
                const float s0 = side(p, q, x), s1 = side(q, r, x), s2 = side(r, p, x);
                if (std::min({s0, s1, s2}) >= -slack || std::max({s0, s1, s2}) <= slack)
                    covered[size_t(j * cells + i)] = true;
            }
    };

    std::vector<glm::vec3> positionsWorld;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
            if (posedBounds(scene, pose, n, primitive).min.y > highest) continue;
            const glm::mat4& matrix = worldFromModel(pose, scene, n, primitive);
            const float winding = glm::determinant(glm::mat3(matrix)) < 0 ? -1.0f : 1.0f;
            const bool doubleSided = scene.materials[size_t(primitive.material)].doubleSided;
            posedPositions(scene, pose, n, primitive, positionsWorld);
            const auto corner = [&](uint32_t i) { return positionsWorld[scene.indices[primitive.firstIndex + i]]; };
            for (uint32_t i = 0; i < primitive.indexCount; i += 3) {
                const glm::vec3 a = corner(i), b = corner(i + 1), c = corner(i + 2);
                if (std::max({a.y, b.y, c.y}) > highest) continue;
                // Scaled to the scene's size, so that the cross product of a tiny scene does not underflow.
                const glm::vec3 normal = winding * glm::cross((b - a) / extent.x, (c - a) / extent.x);
                const float up = doubleSided ? std::abs(normal.y) : normal.y;
                if (up > 0.7f * glm::length(normal)) cover(a, b, c);
            }
        }
    }
    return std::count(covered.begin(), covered.end(), true) * 2 < cells * cells;
}

} // namespace penumbra
