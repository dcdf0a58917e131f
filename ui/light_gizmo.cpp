// SPDX-License-Identifier: MIT
#include "ui/light_gizmo.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

glm::vec2 halfExtent(const AreaLight& light) { // at the light's place [m]
    const float scale =
        light.shape == LightShape::Directional ? glm::distance(light.position, light.target) : 1.0f; // tan to metres
    return scale * halfSize(light);
}

float distanceToSegment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
    const glm::vec2 along = b - a;
    const float length2 = glm::dot(along, along);
    const float t = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0f, 1.0f) : 0.0f;
    return glm::distance(p, a + t * along);
}

// Where the pointer's ray meets the light's plane, in light space; nothing where it runs along it.
std::optional<glm::vec2> onLight(const AreaLight& light, const ScreenView& screen, glm::vec2 point) {
    const glm::mat4 matrix = lightFromWorld(light);
    const glm::vec3 origin(matrix * glm::vec4(screen.view.eyeWorld, 1));
    const glm::vec3 direction = glm::mat3(matrix) * screen.ray(point);
    if (std::abs(direction.z) < 0.05f * glm::length(direction)) return std::nullopt;
    const float t = -origin.z / direction.z;
    if (t <= 0) return std::nullopt;
    return glm::vec2(origin + t * direction);
}

float ratio(float from, float to) { return from > 0 ? std::clamp(to / from, 0.5f, 2.0f) : 1.0f; }

} // namespace

std::optional<glm::vec2> ScreenView::project(glm::vec3 world) const {
    const glm::vec4 clip = view.clipFromWorld * glm::vec4(world, 1);
    if (clip.w <= 0) return std::nullopt;
    return corner + size * (0.5f + glm::vec2(0.5f, -0.5f) * glm::vec2(clip) / clip.w);
}

std::optional<std::pair<glm::vec2, glm::vec2>> ScreenView::project(glm::vec3 fromWorld, glm::vec3 toWorld) const {
    const float nearest = view.near, a = depth(fromWorld), b = depth(toWorld);
    if (a < nearest && b < nearest) return std::nullopt;
    if (a < nearest) fromWorld = glm::mix(fromWorld, toWorld, (nearest - a) / (b - a));
    if (b < nearest) toWorld = glm::mix(toWorld, fromWorld, (nearest - b) / (a - b));
    const auto from = project(fromWorld), to = project(toWorld);
    if (!from || !to) return std::nullopt;
    return std::pair(*from, *to);
}

glm::vec3 ScreenView::ray(glm::vec2 point) const {
    const glm::vec2 place = (point - corner) / size; // pictures count their rows from below
    return view.rayCorner + place.x * static_cast<float>(view.size.x) * view.rayDx +
           (1 - place.y) * static_cast<float>(view.size.y) * view.rayDy;
}

float ScreenView::depth(glm::vec3 world) const { return -(view.eyeFromWorld * glm::vec4(world, 1)).z; }

LightOutline lightOutline(const AreaLight& light) {
    const glm::mat4 worldFromLight = glm::inverse(lightFromWorld(light));
    const bool round = light.shape != LightShape::Rectangle;
    const int corners = round ? 48 : 4;
    LightOutline outline;
    for (int i = 0; i < corners; ++i) {
        const float angle = glm::radians(360.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(corners));
        const float reach = round ? 1.0f : std::sqrt(2.0f); // of the unit square's corners
        const glm::vec2 place = halfExtent(light) * reach * glm::vec2(std::cos(angle), std::sin(angle));
        outline.push_back(glm::vec3(worldFromLight * glm::vec4(place, 0, 1)));
    }
    return outline;
}

// A rectangle's edges, from the corner at +X +Y on: above, left, below, right.
LightHandle edgeAt(const AreaLight& light, size_t i) {
    return light.shape == LightShape::Rectangle && i % 2 == 0 ? LightHandle::Height : LightHandle::Width;
}

LightHandle handleAt(const AreaLight& light, const ScreenView& screen, glm::vec2 pointer, float reach) {
    const auto near = [&](glm::vec3 world) {
        const auto place = screen.project(world);
        return place && glm::distance(*place, pointer) <= reach;
    };
    if (near(light.position)) return LightHandle::Centre;
    if (near(light.target)) return LightHandle::Target;
    const LightOutline outline = lightOutline(light);
    LightHandle nearest = LightHandle::None;
    float distance = reach;
    for (size_t i = 0; i < outline.size(); ++i) {
        const auto edge = screen.project(outline[i], outline[(i + 1) % outline.size()]);
        if (!edge) continue;
        const float d = distanceToSegment(pointer, edge->first, edge->second);
        if (d > distance) continue;
        distance = d;
        nearest = edgeAt(light, i);
    }
    return nearest;
}

void dragHandle(AreaLight& light, LightHandle handle, const ScreenView& screen, glm::vec2 from, glm::vec2 to,
                bool uniformly, float sceneSize) {
    // Parallel to the view, at the depth of what is moved.
    const auto moved = [&](glm::vec3 point) {
        return point + std::max(screen.depth(point), 0.0f) * (screen.ray(to) - screen.ray(from));
    };
    switch (handle) {
    case LightHandle::None: return;
    case LightHandle::Centre: return put(light.position, moved(light.position), light.target, sceneSize);
    case LightHandle::Target: return put(light.target, moved(light.target), light.position, sceneSize);
    case LightHandle::Width:
    case LightHandle::Height: break;
    }
    glm::vec2 factors(1);
    const auto a = onLight(light, screen, from), b = onLight(light, screen, to);
    if (light.shape != LightShape::Rectangle) {
        // Seen from the edge a disk still has its reach on the screen.
        const auto centre = screen.project(light.position);
        if (a && b)
            factors = glm::vec2(ratio(glm::length(*a), glm::length(*b)));
        else if (centre)
            factors = glm::vec2(ratio(glm::distance(*centre, from), glm::distance(*centre, to)));
    } else if (a && b) {
        const int axis = handle == LightHandle::Width ? 0 : 1;
        factors[axis] = ratio(std::abs((*a)[axis]), std::abs((*b)[axis]));
        if (uniformly) factors = glm::vec2(factors[axis]);
    }
    scaleLight(light, factors);
}

} // namespace penumbra
