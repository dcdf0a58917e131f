// SPDX-License-Identifier: MIT
// The built-in scenes whose shadow on the floor is known exactly, and what it is. Light at height 10 [m], facing down,
// casters at height 6, floor at 0.
#pragma once

#include "renderer/session.h"

#include <glm/glm.hpp>

namespace penumbra::test {

struct ClosedForm {
    const char* scene;
    double (*psi)(glm::dvec3 position);                     // of a point of the floor
    bool (*hides)(glm::dvec3 position, glm::dvec2 onLight); // whether the point (x, z) of the light is hidden from it
};
double halfPlanePsi(glm::dvec3 position);
double rectanglePsi(glm::dvec3 position);
double spherePsi(glm::dvec3 position);
bool halfPlaneHides(glm::dvec3 position, glm::dvec2 onLight);
bool rectangleHides(glm::dvec3 position, glm::dvec2 onLight);
bool sphereHides(glm::dvec3 position, glm::dvec2 onLight);
inline constexpr ClosedForm closedForms[] = {{"half-plane", halfPlanePsi, halfPlaneHides},
                                             {"rectangle", rectanglePsi, rectangleHides},
                                             {"sphere", spherePsi, sphereHides}};

// ψ under a sphere in a disk light at height H around the axis: radii of light and sphere, the sphere's height.
double sphereUnderDisk(double lightRadius, double sphereRadius, double H, double h, glm::dvec2 place);

Session closedFormSession(const ClosedForm& form, glm::ivec2 size);
// Whether a pixel's surface is floor that the closed form speaks of.
bool onKnownFloor(glm::vec3 position);

} // namespace penumbra::test
