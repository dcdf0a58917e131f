// SPDX-License-Identifier: MIT
// Triangle meshes in double precision and what they are put together from. Solids are closed and face outwards, so that
// their backs need no drawing into a shadow map.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace make_scenes {

using glm::dvec2, glm::dvec3, glm::dmat4;
constexpr double pi = glm::pi<double>();

// A linear congruential generator (Knuth's MMIX), since the standard distributions differ between libraries.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double operator()(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * double(state_ >> 40) / double(1 << 24);
    }

private:
    uint64_t state_;
};

struct Vertex {
    dvec3 position{0}, normal{0, 1, 0};
    dvec2 uv{0};
};

struct Shape {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;

    size_t add(const Vertex& vertex);
    void triangle(size_t a, size_t b, size_t c);
    // Counter-clockwise seen from where it faces; uv runs (0, 0), (1, 0), (1, 1), (0, 1).
    void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
    void add(const Shape& other, const dmat4& matrix = dmat4(1));
};

dmat4 moved(const dvec3& by);
dmat4 turned(double degrees, const dvec3& axis);
dmat4 scaled(const dvec3& by);

Shape box(const dvec3& low, const dvec3& high);
Shape boxAround(const dvec3& centre, const dvec3& size);

// A grid of (columns + 1) x (rows + 1) vertices, facing ∂u × ∂v of `surface`, which maps [0, 1]² to vertices.
Shape patch(int columns, int rows, const std::function<Vertex(double, double)>& surface);
Shape sphere(const dvec3& centre, double radius, int segments);
Shape torus(double radius, double thickness, int segments, int sides);

// Turns a profile of (radius, height), listed from below with its outside to the right, about the y axis. Corners
// sharper than 40 degrees stay sharp.
Shape lathe(const std::vector<dvec2>& profile, int segments);
Shape cylinder(double radius, double height, int segments);
Shape rod(const dvec3& from, const dvec3& to, double radius, int segments);
Shape rods(const std::vector<dvec3>& points, double radius, int segments); // along a line of points
Shape taper(const dvec3& from, const dvec3& to, double radius, double endRadius, int segments);

// The profile, counter-clockwise and convex, drawn out along z from −depth/2 to depth/2.
Shape prism(const std::vector<dvec2>& profile, double depth);

// A wall from x = −width/2 to width/2 with a round-arched opening, its front at z = thickness/2.
Shape archBay(double width, double height, double opening, double spring, double thickness, int segments);

// Texture coordinates from the place: a picture is `metres` wide on faces along each axis.
Shape mappedByPlace(Shape shape, double metres);

} // namespace make_scenes
