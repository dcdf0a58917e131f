// SPDX-License-Identifier: MIT
// How a hand moves the camera and the light. Angles in degrees, lengths in metres; `sceneSize` is the diagonal of the
// scene's bounds and keeps movements sensible from millimetres to kilometres.
#pragma once

#include "renderer/session.h"

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
// Moves along right, up and forward of the camera [m].
void fly(Camera& camera, glm::vec3 rightUpForward);
// Keeps the direction and steps back until the bounds fill a view of this aspect ratio.
void frameBounds(Camera& camera, const Bounds& bounds, float aspect);

void orbitLight(AreaLight& light, float right, float up);
// Brings it nearer to its target by 15 percent a notch.
void moveLight(AreaLight& light, float notches, float sceneSize);
// Scales the light's width and height, or the tangent of half its angle, within their limits.
void scaleLight(AreaLight& light, glm::vec2 factors);

// What a hand does in one frame, by mouse or by keys.
struct Motion {
    glm::vec2 turn{0}; // round the target: right, up [degrees]
    glm::vec2 look{0}; // round the eye: right, up [degrees]
    glm::vec2 pan{0};  // as pan()
    float nearer = 0;  // notches
    glm::vec3 fly{0};  // right, up, forward of the camera [m]
    bool operator==(const Motion&) const = default;
};
void move(Camera& camera, const Motion& motion, float viewHeight, float sceneSize);
// The light as seen by the camera: pan shifts it with its target, fly leaves its target where it is.
void move(AreaLight& light, const Camera& camera, const Motion& motion, float viewHeight, float sceneSize);
// Puts a point to where it is wanted, unless it would meet the `other`: a thing cannot look at where it is.
void put(glm::vec3& point, glm::vec3 wanted, glm::vec3 other, float sceneSize);

// Where the light stands as seen from its target: azimuth about +Y from +Z [degrees, (−180, 180]], elevation above the
// horizon [degrees, ±89.9], distance [m].
struct LightDirection {
    float azimuth, elevation, distance;
};
LightDirection lightDirection(const AreaLight& light);
void setLightDirection(AreaLight& light, const LightDirection& direction);

// A line across a shadow's edge; its ends in shares of the picture from the upper left corner.
struct RulerLine {
    glm::vec2 from{0.4f, 0.4f}, to{0.6f, 0.4f};
};

// What the panels and the keys of the view share.
struct ViewSettings {
    float flySpeed = 0.2f; // scene sizes per second
    bool lightShown = false;
    bool rulerShown = false;
    RulerLine ruler;

    void changeSpeed(float notches); // a fourth faster each
};

} // namespace penumbra
