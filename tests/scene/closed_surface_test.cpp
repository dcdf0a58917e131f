// SPDX-License-Identifier: MIT
#include "renderer/scene/closed_surface.h"
#include "tests/catch.h"

using namespace penumbra;

namespace {

// A tetrahedron with its corners shared by position only, as glTF writes flat shaded faces.
struct Solid {
    Scene scene;
    Primitive primitive;

    void face(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
        for (const glm::vec3 p : {a, b, c}) {
            scene.indices.push_back(primitive.vertexCount++);
            scene.positions.push_back(p);
            primitive.bounds.add(p);
        }
        primitive.indexCount += 3;
    }
    void tetrahedron(glm::vec3 at, bool inverted = false) {
        const glm::vec3 o = at, x = at + glm::vec3(1, 0, 0), y = at + glm::vec3(0, 1, 0), z = at + glm::vec3(0, 0, 1);
        const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) { inverted ? face(a, c, b) : face(a, b, c); };
        add(o, y, x);
        add(o, x, z);
        add(o, z, y);
        add(x, y, z);
    }
    bool closed() const { return isClosedSurface(scene, primitive); }
};

} // namespace

TEST_CASE("a closed surface is one whose edges pair up and whose parts face outwards") {
    Solid solid;
    CHECK_FALSE(solid.closed()); // nothing
    solid.tetrahedron({0, 0, 0});
    CHECK(solid.closed());

    Solid two = solid;
    two.tetrahedron({5, 0, 0});
    CHECK(two.closed());
    two.tetrahedron({-5, 0, 0}, true); // a part turned inside out
    CHECK_FALSE(two.closed());

    Solid open = solid;
    open.primitive.indexCount -= 3;
    CHECK_FALSE(open.closed());

    Solid twice = solid;
    twice.face({1, 0, 0}, {0, 1, 0}, {0, 0, 1}); // a face once more
    CHECK_FALSE(twice.closed());

    Solid withNeedle = solid;
    withNeedle.face({0, 0, 0}, {0, 0, 0}, {1, 0, 0}); // no area, no edge
    CHECK(withNeedle.closed());

    Solid sheet;
    sheet.face({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    CHECK_FALSE(sheet.closed());
    sheet.face({0, 0, 0}, {0, 1, 0}, {1, 0, 0}); // both sides of a sheet: edges pair up, no volume
    CHECK_FALSE(sheet.closed());
}

TEST_CASE("flat things and convex closed ones do not shade themselves") {
    Solid solid;
    solid.tetrahedron({0, 0, 0});
    solid.primitive.closed = true;
    CHECK_FALSE(mayShadeItself(solid.scene, solid.primitive));
    Solid hole = solid; // its inside is seen through
    hole.primitive.indexCount -= 3;
    hole.primitive.closed = false;
    CHECK(mayShadeItself(hole.scene, hole.primitive));
    solid.tetrahedron({3, 0, 0}); // each shades the other
    CHECK(mayShadeItself(solid.scene, solid.primitive));
    Solid sheet;
    sheet.face({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    sheet.face({1, 1, 0}, {0, 1, 0}, {1, 0, 0});
    CHECK_FALSE(mayShadeItself(sheet.scene, sheet.primitive));
    Solid bent = sheet;
    bent.face({1, 1, 0}, {2, 1, 0.001f}, {1, 2, 0});
    CHECK(mayShadeItself(bent.scene, bent.primitive));
}
