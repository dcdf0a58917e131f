// SPDX-License-Identifier: MIT
#include "renderer/scene/light.h"
#include "tests/catch.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace penumbra;

TEST_CASE("light space is orthonormal and looks down -Z from anywhere") {
    const glm::vec3 directions[] = {{0, 1, 0},     {0, -1, 0}, {1, 0, 0},  {0, 0, -1},
                                    {1e-8f, 1, 0}, {1, 2, 3},  {-3, -1, 2}};
    for (const glm::vec3& direction : directions)
        for (const float distance : {1e-3f, 1.0f, 1e4f}) {
            AreaLight light;
            light.target = {1, 2, 3};
            light.position = light.target + distance * direction;
            const glm::mat4 matrix = lightFromWorld(light);
            const glm::mat3 rotation(matrix);
            CAPTURE(direction.x, direction.y, direction.z, distance);
            CHECK(glm::determinant(rotation) == Approx(1).epsilon(1e-5));
            const glm::mat3 unity = rotation * glm::transpose(rotation);
            for (int i = 0; i < 9; ++i) CHECK(unity[i / 3][i % 3] == Approx(i % 4 == 0 ? 1 : 0).margin(1e-5));
            const glm::vec3 targetLight(matrix * glm::vec4(light.target, 1));
            const float length = glm::length(light.position - light.target);
            CHECK(targetLight.z == Approx(-length).epsilon(1e-4));
            CHECK(std::hypot(targetLight.x, targetLight.y) <= 1e-4f * length);
        }
}

TEST_CASE("a light straight above has its width along world X and one on its target looks down") {
    AreaLight light;
    light.position = {0, 4, 0};
    const glm::mat4 above = lightFromWorld(light);
    CHECK(glm::vec3(above * glm::vec4(1, 4, 0, 1)) == glm::vec3(1, 0, 0));
    light.position = light.target;
    const glm::vec3 below(lightFromWorld(light) * glm::vec4(0, -1, 0, 1));
    CHECK(below == glm::vec3(0, 0, -1));
}

TEST_CASE("light points fill the shape evenly") {
    AreaLight rectangle;
    rectangle.size = {2, 1};
    CHECK(lightPoint(rectangle, {0, 0}) == glm::vec2(-1, -0.5f));
    CHECK(lightPoint(rectangle, {0.5f, 0.5f}) == glm::vec2(0));

    AreaLight disk;
    disk.shape = LightShape::Disk;
    disk.size = glm::vec2(3); // radius 1.5
    AreaLight sun;
    sun.shape = LightShape::Directional;
    sun.size = glm::vec2(2); // degrees
    CHECK(halfSize(sun).x == Approx(std::tan(glm::radians(1.0f))));

    for (const AreaLight& light : {disk, sun}) {
        const float radius = halfSize(light).x;
        // Area preserving: half of the points of a regular grid lie within the radius / √2, also in each half plane.
        constexpr int n = 400;
        int inner = 0, right = 0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const glm::vec2 p = lightPoint(light, (glm::vec2(i, j) + 0.5f) / float(n));
                REQUIRE(glm::length(p) <= radius * 1.0001f);
                if (glm::length(p) < radius / std::sqrt(2.0f)) {
                    ++inner;
                    right += p.x > 0;
                }
            }
        CHECK(inner / float(n * n) == Approx(0.5f).margin(0.005f));
        CHECK(right / float(inner) == Approx(0.5f).margin(0.005f));
        CHECK(lightPoint(light, {0.5f, 0.5f}) == glm::vec2(0));
    }
}

TEST_CASE("the shapes have names in their order") {
    REQUIRE(lightShapeNames().size() == 3);
    CHECK(lightShapeNames()[size_t(LightShape::Disk)] == "disk");
}

TEST_CASE("of Sobol's first 2^k points every rectangle of area 2^-k that comes of halving the sides holds one") {
    for (const uint32_t seed : {0u, 1u, 77u})
        for (uint32_t k = 0; k <= 8; ++k)
            for (uint32_t columns = 0; columns <= k; ++columns) {
                std::vector<int> held(size_t{1} << k);
                for (uint32_t i = 0; i < 1u << k; ++i) {
                    const glm::vec2 p = sobolPoint(i, seed);
                    REQUIRE((p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1));
                    const auto x = static_cast<size_t>(p.x * float(1u << columns)),
                               y = static_cast<size_t>(p.y * float(1u << (k - columns)));
                    ++held[y << columns | x];
                }
                CHECK(std::count(held.begin(), held.end(), 1) == std::ptrdiff_t(held.size()));
            }
    CHECK(sobolPoint(5, 0) != sobolPoint(5, 1));
}
