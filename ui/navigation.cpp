// SPDX-License-Identifier: MIT
#include "ui/navigation.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float steepest = 89.9f; // degrees above the horizon; at 90 the azimuth would be lost
constexpr float zoomPerNotch = 0.85f;

// `offset` turned about the axis by `right` and towards the axis by `up` degrees.
glm::vec3 turned(glm::vec3 offset, glm::vec3 axis, float right, float up) {
    offset = glm::rotate(offset, glm::radians(right), axis);
    const glm::vec3 side = glm::cross(axis, offset);
    const float length = glm::length(offset);
    if (glm::length(side) < 1e-6f * length) return offset; // looks along the axis: no side to turn about
    const float elevation = glm::degrees(std::asin(std::clamp(glm::dot(offset, axis) / length, -1.0f, 1.0f)));
    const float wanted = std::clamp(elevation + up, -steepest, steepest);
    return glm::rotate(offset, glm::radians(elevation - wanted), glm::normalize(side));
}

float notchFactor(float notches) { return std::pow(zoomPerNotch, notches); }

struct Axes {
    glm::vec3 right, up, forward;
};
Axes axesOf(const Camera& camera) {
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    glm::vec3 right = glm::cross(forward, camera.up);
    if (glm::length(right) < 1e-5f) right = glm::cross(forward, glm::vec3(0, 0, -1));
    if (glm::length(right) < 1e-5f) right = glm::vec3(1, 0, 0);
    right = glm::normalize(right);
    return {right, glm::cross(right, forward), forward};
}

// How near and how far a thing may be moved from what it looks at.
float clampDistance(float distance, float sceneSize) {
    return std::clamp(distance, 1e-3f * sceneSize, 100.0f * sceneSize);
}

} // namespace

void orbit(Camera& camera, float right, float up) {
    camera.eye = camera.target + turned(camera.eye - camera.target, glm::normalize(camera.up), right, up);
}

void look(Camera& camera, float right, float up) {
    camera.target = camera.eye + turned(camera.target - camera.eye, glm::normalize(camera.up), right, up);
}

void pan(Camera& camera, glm::vec2 pixels, float viewHeight) {
    const float distance = glm::length(camera.target - camera.eye);
    const float metresPerPixel = 2 * distance * std::tan(glm::radians(camera.fovY) / 2) / std::max(viewHeight, 1.0f);
    const Axes axes = axesOf(camera);
    const glm::vec3 shift = metresPerPixel * (-pixels.x * axes.right + pixels.y * axes.up);
    camera.eye += shift;
    camera.target += shift;
}

void zoom(Camera& camera, float notches, float sceneSize) {
    const glm::vec3 offset = camera.eye - camera.target;
    const float distance = glm::length(offset);
    camera.eye = camera.target + offset * (clampDistance(distance * notchFactor(notches), sceneSize) / distance);
}

void fly(Camera& camera, glm::vec3 rightUpForward) {
    const Axes axes = axesOf(camera);
    const glm::vec3 shift =
        rightUpForward.x * axes.right + rightUpForward.y * axes.up + rightUpForward.z * axes.forward;
    camera.eye += shift;
    camera.target += shift;
}

void frameBounds(Camera& camera, const Bounds& bounds, float aspect) {
    if (bounds.empty()) return;
    const float radius = std::max(bounds.diagonal() / 2, 1e-6f);
    const float tanHalf = std::tan(glm::radians(camera.fovY) / 2) * std::min(aspect, 1.0f);
    const float distance = radius / std::sin(std::atan(tanHalf));
    const glm::vec3 backward = -axesOf(camera).forward;
    camera.target = bounds.centre();
    camera.eye = camera.target + distance * backward;
}

void orbitLight(AreaLight& light, float right, float up) {
    LightDirection direction = lightDirection(light);
    direction.azimuth += right;
    direction.elevation += up;
    setLightDirection(light, direction);
}

void moveLightAway(AreaLight& light, float notches, float sceneSize) {
    LightDirection direction = lightDirection(light);
    direction.distance = clampDistance(direction.distance / notchFactor(notches), sceneSize);
    setLightDirection(light, direction);
}

LightDirection lightDirection(const AreaLight& light) {
    const glm::vec3 offset = light.position - light.target;
    const float distance = glm::length(offset);
    const bool vertical = std::abs(offset.x) + std::abs(offset.z) == 0;
    return {vertical ? 0.0f : glm::degrees(std::atan2(offset.x, offset.z)),
            glm::degrees(std::asin(std::clamp(offset.y / distance, -1.0f, 1.0f))), distance};
}

void setLightDirection(AreaLight& light, const LightDirection& direction) {
    const float azimuth = glm::radians(std::remainder(direction.azimuth, 360.0f));
    const float elevation = glm::radians(std::clamp(direction.elevation, -steepest, steepest));
    light.position =
        light.target + direction.distance * glm::vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                                      std::cos(elevation) * std::cos(azimuth));
}

} // namespace penumbra
