// SPDX-License-Identifier: MIT
// The light as it is drawn in the view, to be taken by the hand: its centre, its target and its edge.
#pragma once

#include "ui/navigation.h"

#include "renderer/core/fixed_vector.h"

#include <optional>
#include <utility>

namespace penumbra {

// A view on the screen, in units of the window from its upper left corner.
struct ScreenView {
    View view;
    glm::vec2 corner{0}, size{1};

    std::optional<glm::vec2> project(glm::vec3 world) const; // nothing: not before the eye
    // The part of a line that lies before the eye.
    std::optional<std::pair<glm::vec2, glm::vec2>> project(glm::vec3 fromWorld, glm::vec3 toWorld) const;
    glm::vec3 ray(glm::vec2 point) const; // world, from the eye, of eye depth 1
    float depth(glm::vec3 world) const;   // eye depth [m]
};

enum class LightHandle {
    None,
    Centre, // moves the light
    Target, // aims it
    Width,  // the edges to its sides, or of a round light: its diameter
    Height, // the edges above and below
};

// The light's edge, world, closed; of a directional light the disk that subtends its angle from the target.
using LightOutline = FixedVector<glm::vec3, 48>;
LightOutline lightOutline(const AreaLight& light);
// What a hand takes at the line from point i of the outline to the next.
LightHandle edgeAt(const AreaLight& light, size_t i);
// What lies under the pointer, within `reach` units of it.
LightHandle handleAt(const AreaLight& light, const ScreenView& screen, glm::vec2 pointer, float reach);
// Follows the pointer from one place to the next. `uniformly`: width and height keep their ratio.
void dragHandle(AreaLight& light, LightHandle handle, const ScreenView& screen, glm::vec2 from, glm::vec2 to,
                bool uniformly, float sceneSize);

} // namespace penumbra
