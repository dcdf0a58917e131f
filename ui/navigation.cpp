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
constexpr float slowestFlight = 0.001f, fastestFlight = 10; // scene sizes a second

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

glm::vec3 inWorld(const Camera& camera, glm::vec3 rightUpForward) {
    const Axes axes = axesOf(camera);
    return rightUpForward.x * axes.right + rightUpForward.y * axes.up + rightUpForward.z * axes.forward;
}

// How far something at that distance moves to follow the pointer by `pixels` to the right and down.
glm::vec3 shiftOf(const Camera& camera, glm::vec2 pixels, float viewHeight, float distance) {
    const float metresPerPixel = 2 * distance * std::tan(glm::radians(camera.fovY) / 2) / std::max(viewHeight, 1.0f);
    return metresPerPixel * inWorld(camera, {pixels.x, -pixels.y, 0});
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
    const glm::vec3 shift = shiftOf(camera, pixels, viewHeight, glm::length(camera.target - camera.eye));
    camera.eye -= shift;
    camera.target -= shift;
}

void zoom(Camera& camera, float notches, float sceneSize) {
    const glm::vec3 offset = camera.eye - camera.target;
    const float distance = glm::length(offset);
    camera.eye = camera.target + offset * (clampDistance(distance * notchFactor(notches), sceneSize) / distance);
}

void fly(Camera& camera, glm::vec3 rightUpForward) {
    const glm::vec3 shift = inWorld(camera, rightUpForward);
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

void moveLight(AreaLight& light, float notches, float sceneSize) {
    LightDirection direction = lightDirection(light);
    direction.distance = clampDistance(direction.distance * notchFactor(notches), sceneSize);
    setLightDirection(light, direction);
}

void scaleLight(AreaLight& light, glm::vec2 factors) {
    const auto scaled = [](float value, float factor, Range limits) {
        return std::clamp(value * factor, static_cast<float>(limits.min), static_cast<float>(limits.max));
    };
    if (light.shape == LightShape::Directional) {
        const float tangent = std::tan(0.5f * glm::radians(light.size.x)) * factors.x;
        light.size = glm::vec2(scaled(glm::degrees(2 * std::atan(tangent)), 1, limits::lightDegrees));
    } else {
        light.size = {scaled(light.size.x, factors.x, limits::lightMetres),
                      scaled(light.size.y, factors.y, limits::lightMetres)};
    }
}

void move(Camera& camera, const Motion& motion, float viewHeight, float sceneSize) {
    if (motion.turn != glm::vec2(0)) orbit(camera, motion.turn.x, motion.turn.y);
    if (motion.look != glm::vec2(0)) look(camera, motion.look.x, motion.look.y);
    if (motion.pan != glm::vec2(0)) pan(camera, motion.pan, viewHeight);
    if (motion.nearer != 0) zoom(camera, motion.nearer, sceneSize);
    if (motion.fly != glm::vec3(0)) fly(camera, motion.fly);
}

void move(AreaLight& light, const Camera& camera, const Motion& motion, float viewHeight, float sceneSize) {
    if (motion.turn != glm::vec2(0)) orbitLight(light, motion.turn.x, motion.turn.y);
    if (motion.pan != glm::vec2(0)) {
        const glm::vec3 shift =
            shiftOf(camera, motion.pan, viewHeight, glm::dot(light.target - camera.eye, axesOf(camera).forward));
        light.position += shift;
        light.target += shift;
    }
    if (motion.nearer != 0) moveLight(light, motion.nearer, sceneSize);
    if (motion.fly != glm::vec3(0))
        put(light.position, light.position + inWorld(camera, motion.fly), light.target, sceneSize);
}

void put(glm::vec3& point, glm::vec3 wanted, glm::vec3 other, float sceneSize) {
    if (glm::distance(wanted, other) >= 1e-5f * sceneSize) point = wanted;
}

void ViewSettings::changeSpeed(float notches) {
    flySpeed = std::clamp(flySpeed * std::pow(1.25f, notches), slowestFlight, fastestFlight);
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
