// SPDX-License-Identifier: MIT
// Small scenes made in memory, and ψ drawn on them.
#pragma once

#include "app/headless.h"
#include "renderer/renderer.h"

#include <memory>

namespace penumbra::test {

// One context and renderer for a whole test program; the test fails if the driver ever complained.
Renderer& renderer();
std::vector<std::string> driverMessages();
// For tests that make the driver complain on purpose: starts the list anew.
void forgetDriverMessages();

// Builds a scene of boxes and quads, each a node of its own in world coordinates.
class SceneBuilder {
public:
    // Corners in order; the normal follows from them counter-clockwise.
    SceneBuilder& quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
    SceneBuilder& box(glm::vec3 min, glm::vec3 max);
    // A horizontal square around the origin, tilted about the x axis.
    SceneBuilder& floor(float halfSize, float tiltDegrees = 0);
    SceneBuilder& triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c);
    std::shared_ptr<const Scene> build() const;
    // As one mesh of one primitive.
    std::shared_ptr<const Scene> merged() const;
    // The last triangle once more: nothing changes but that the surface is no longer closed.
    SceneBuilder& twice();

private:
    Scene scene_;
};

// A floor, and above it a board that a joint bends and a morph target bulges, both by the clip "wave" of 1 s; a rigid
// box stands beside it.
std::shared_ptr<Scene> wavingScene();

// A session of a technique at its defaults: small picture, light 1x1 m at (0, 4, 0) facing down; progressive, as in the
// window.
Session session(std::shared_ptr<const Scene> scene, std::string_view technique = "hard");
// With a small map, where many frames are drawn.
inline constexpr int quickMap = 256;
Session quickSession(std::shared_ptr<const Scene> scene, std::string_view technique);

struct ShadowImage {
    Renderer::Pixels psi, depth; // row 0 at the top
    View view;
    bool surface(int x, int y) const { return depth.values[index(x, y)] > 0; }
    float at(int x, int y) const { return psi.values[index(x, y)]; }
    glm::vec3 positionWorld(int x, int y) const;
    double meanOverSurface() const;
    size_t index(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(psi.width) + static_cast<size_t>(x);
    }
};
ShadowImage draw(const Session& session);

} // namespace penumbra::test
