// SPDX-License-Identifier: MIT
// How a hand moves the camera and the light. Angles in degrees, lengths in metres; `sceneSize` is the diagonal of the
// scene's bounds and keeps movements sensible from millimetres to kilometres.
#pragma once

#include "renderer/scene/scene.h"

namespace penumbra {

// Turns the eye round the target; `right` about the camera's up axis, `up` towards the pole but never over it.
void orbit(Camera& camera, float right, float up);
// Turns the target round the eye in the same way.
void look(Camera& camera, float right, float up);
// Shifts eye and target so that what lies at the target's distance follows the pointer, in pixels of a view of
// `viewHeight` pixels.
void pan(Camera& camera, glm::vec2 pixels, float viewHeight);
// Brings the eye nearer to the target by 15 percent a notch.
void zoom(Camera& camera, float notches, float sceneSize);
// Moves along right, up and forward of the camera.
void fly(Camera& camera, glm::vec3 rightUpForward);
// Keeps the direction and steps back until the bounds fill a view of this aspect ratio.
void frameBounds(Camera& camera, const Bounds& bounds, float aspect);

void orbitLight(AreaLight& light, float right, float up);
void moveLightAway(AreaLight& light, float notches, float sceneSize);

// Where the light stands as seen from its target: azimuth about +Y from +Z [degrees, (−180, 180]], elevation above the
// horizon [degrees, ±89.9], distance [m].
struct LightDirection {
    float azimuth, elevation, distance;
};
LightDirection lightDirection(const AreaLight& light);
void setLightDirection(AreaLight& light, const LightDirection& direction);

} // namespace penumbra
