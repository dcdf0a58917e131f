// SPDX-License-Identifier: MIT
#include "renderer/scene/part_bounds.h"
#include "tests/catch.h"

#include <cmath>

using namespace penumbra;

TEST_CASE("the parts of a primitive hold every triangle of it, in boxes that are much smaller together than one") {
    // A rising ring of 512 triangles: one box around it is mostly empty.
    Scene scene;
    Primitive primitive;
    for (uint32_t i = 0; i < 512; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / 512;
        for (const float by : {0.0f, 0.01f, 0.02f}) {
            const glm::vec3 p(std::cos(angle + by), 0.1f * angle + by, std::sin(angle + by));
            scene.positions.push_back(p);
            scene.indices.push_back(primitive.vertexCount++);
            primitive.bounds.add(p);
        }
        primitive.indexCount += 3;
    }
    const std::vector<Bounds> parts = partBounds(scene, primitive);
    REQUIRE(parts.size() > 1);
    REQUIRE(parts.size() <= 64);
    const auto volume = [](const Bounds& box) { return box.extent().x * box.extent().y * box.extent().z; };
    Bounds all;
    float together = 0;
    for (const Bounds& part : parts) all.add(part), together += volume(part);
    CHECK(all.min == primitive.bounds.min);
    CHECK(all.max == primitive.bounds.max);
    CHECK(together < 0.2f * volume(primitive.bounds));
    for (size_t first = 0; first < scene.positions.size(); first += 3)
        CHECK(std::any_of(parts.begin(), parts.end(), [&](const Bounds& box) {
            return std::all_of(scene.positions.begin() + static_cast<std::ptrdiff_t>(first),
                               scene.positions.begin() + static_cast<std::ptrdiff_t>(first) + 3, [&](glm::vec3 p) {
                                   return glm::all(glm::lessThanEqual(box.min, p)) &&
                                          glm::all(glm::lessThanEqual(p, box.max));
                               });
        }));

    primitive.indexCount = 30; // one box does
    CHECK(partBounds(scene, primitive).empty());
}
