// SPDX-License-Identifier: MIT
#include "assets/make_scenes/shapes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace make_scenes {
namespace {

// From the y axis to the line between two points.
dmat4 along(const dvec3& from, const dvec3& to) {
    const dvec3 y = glm::normalize(to - from);
    const dvec3 x = glm::normalize(glm::cross(y, std::abs(y.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, 1)));
    return moved(from) * dmat4(glm::dmat3(x, y, glm::cross(x, y)));
}

} // namespace

size_t Shape::add(const Vertex& vertex) {
    vertices.push_back(vertex);
    return vertices.size() - 1;
}

void Shape::triangle(size_t a, size_t b, size_t c) {
    indices.insert(indices.end(), {uint32_t(a), uint32_t(b), uint32_t(c)});
}

void Shape::quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const dvec3 normal = glm::normalize(glm::cross(c - a, d - b));
    const size_t first = add({a, normal, {0, 0}});
    add({b, normal, {1, 0}});
    add({c, normal, {1, 1}});
    add({d, normal, {0, 1}});
    triangle(first, first + 1, first + 2);
    triangle(first, first + 2, first + 3);
}

void Shape::add(const Shape& other, const dmat4& matrix) {
    const size_t first = vertices.size();
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(matrix)));
    for (const Vertex& v : other.vertices)
        add({dvec3(matrix * glm::dvec4(v.position, 1)), glm::normalize(normalMatrix * v.normal), v.uv});
    for (size_t i = 0; i < other.indices.size(); i += 3)
        triangle(first + other.indices[i], first + other.indices[i + 1], first + other.indices[i + 2]);
}

dmat4 moved(const dvec3& by) { return glm::translate(dmat4(1), by); }
dmat4 turned(double degrees, const dvec3& axis) { return glm::rotate(dmat4(1), glm::radians(degrees), axis); }
dmat4 scaled(const dvec3& by) { return glm::scale(dmat4(1), by); }

Shape box(const dvec3& low, const dvec3& high) {
    const auto p = [&](int x, int y, int z) {
        return dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    Shape shape;
    shape.quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
    shape.quad(p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0));
    shape.quad(p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1));
    shape.quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
    shape.quad(p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0));
    shape.quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
    return shape;
}

Shape boxAround(const dvec3& centre, const dvec3& size) { return box(centre - 0.5 * size, centre + 0.5 * size); }

Shape patch(int columns, int rows, const std::function<Vertex(double, double)>& surface) {
    Shape shape;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) shape.add(surface(double(i) / columns, double(j) / rows));
    const auto at = [&](int i, int j) { return size_t(j * (columns + 1) + i); };
    const auto same = [&](size_t a, size_t b) {
        return glm::distance(shape.vertices[a].position, shape.vertices[b].position) < 1e-9;
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const size_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (!same(a, b)) shape.triangle(a, b, c); // poles have no width
            if (!same(c, d)) shape.triangle(a, c, d);
        }
    return shape;
}

Shape sphere(const dvec3& centre, double radius, int segments) {
    return patch(segments, segments / 2, [&](double u, double v) {
        const double longitude = -2 * pi * u, polar = pi * (1 - v); // from the lower pole upwards
        const double ring = v == 0 || v == 1 ? 0 : std::sin(polar);
        const dvec3 normal(ring * std::cos(longitude), std::cos(polar), ring * std::sin(longitude));
        return Vertex{centre + radius * normal, normal, {u, v}};
    });
}

Shape torus(double radius, double thickness, int segments, int sides) {
    return patch(segments, sides, [&](double u, double v) {
        const double around = -2 * pi * u, across = 2 * pi * v;
        const dvec3 out(std::cos(around), 0, std::sin(around));
        const dvec3 normal = std::cos(across) * out + dvec3(0, std::sin(across), 0);
        return Vertex{radius * out + thickness * normal, normal, {u, v}};
    });
}

Shape lathe(const std::vector<dvec2>& profile, int segments) {
    const auto outward = [&](size_t i) { // of the i-th piece
        const dvec2 along = profile[i + 1] - profile[i];
        return glm::normalize(dvec2(along.y, -along.x));
    };
    Shape shape;
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
        const dvec2 own = outward(i);
        const auto smooth = [&](size_t neighbour, bool exists) {
            if (!exists) return own;
            const dvec2 other = outward(neighbour);
            return glm::dot(own, other) > std::cos(glm::radians(40.0)) ? glm::normalize(own + other) : own;
        };
        const std::array<dvec2, 2> normals{smooth(i - 1, i > 0), smooth(i + 1, i + 2 < profile.size())};
        shape.add(patch(segments, 1, [&](double u, double v) {
            const dvec2 point = profile[i + (v > 0.5)], normal = normals[v > 0.5];
            const dvec3 out(std::cos(-2 * pi * u), 0, std::sin(-2 * pi * u));
            return Vertex{point.x * out + dvec3(0, point.y, 0), normal.x * out + dvec3(0, normal.y, 0), {u, v}};
        }));
    }
    return shape;
}

Shape cylinder(double radius, double height, int segments) {
    return lathe({{0, 0}, {radius, 0}, {radius, height}, {0, height}}, segments);
}

Shape rod(const dvec3& from, const dvec3& to, double radius, int segments) {
    return taper(from, to, radius, radius, segments);
}

Shape taper(const dvec3& from, const dvec3& to, double radius, double endRadius, int segments) {
    const double length = glm::length(to - from);
    Shape shape;
    shape.add(lathe({{0, 0}, {radius, 0}, {endRadius, length}, {0, length}}, segments), along(from, to));
    return shape;
}

Shape rods(const std::vector<dvec3>& points, double radius, int segments) {
    Shape shape;
    for (size_t i = 0; i + 1 < points.size(); ++i) shape.add(rod(points[i], points[i + 1], radius, segments));
    return shape;
}

Shape prism(const std::vector<dvec2>& profile, double depth) {
    const double half = 0.5 * depth;
    Shape shape;
    const auto cap = [&](double z, bool front) {
        const size_t first = shape.vertices.size(), n = profile.size();
        for (const dvec2& p : profile) shape.add({{p.x, p.y, z}, {0, 0, front ? 1 : -1}, p});
        for (size_t i = 1; i + 1 < n; ++i)
            front ? shape.triangle(first, first + i, first + i + 1) : shape.triangle(first, first + i + 1, first + i);
    };
    cap(half, true);
    cap(-half, false);
    for (size_t i = 0; i < profile.size(); ++i) {
        const dvec2 a = profile[i], b = profile[(i + 1) % profile.size()];
        shape.quad({a.x, a.y, half}, {a.x, a.y, -half}, {b.x, b.y, -half}, {b.x, b.y, half});
    }
    return shape;
}

Shape archBay(double width, double height, double opening, double spring, double thickness, int segments) {
    const double half = 0.5 * thickness, pier = 0.5 * (width - opening), r = 0.5 * opening;
    Shape shape;
    shape.add(box({-0.5 * width, 0, -half}, {-0.5 * width + pier, spring, half}));
    shape.add(box({0.5 * width - pier, 0, -half}, {0.5 * width, spring, half}));
    std::vector<dvec2> curve{{-0.5 * width, spring}};
    for (int i = 0; i <= segments; ++i) {
        const double angle = pi * (1 - double(i) / segments);
        curve.push_back({r * std::cos(angle), spring + r * std::sin(angle)});
    }
    curve.push_back({0.5 * width, spring});
    for (size_t i = 0; i + 1 < curve.size(); ++i) {
        const dvec2 a = curve[i], b = curve[i + 1];
        shape.quad({a.x, a.y, half}, {b.x, b.y, half}, {b.x, height, half}, {a.x, height, half});
        shape.quad({b.x, b.y, -half}, {a.x, a.y, -half}, {a.x, height, -half}, {b.x, height, -half});
        shape.quad({a.x, a.y, -half}, {b.x, b.y, -half}, {b.x, b.y, half}, {a.x, a.y, half});
        shape.quad({a.x, height, half}, {b.x, height, half}, {b.x, height, -half}, {a.x, height, -half});
    }
    for (const double side : {-1.0, 1.0}) { // above the piers the ends are open up to here
        const double x = side * 0.5 * width;
        shape.quad({x, spring, side * half}, {x, spring, -side * half}, {x, height, -side * half},
                   {x, height, side * half});
    }
    return shape;
}

Shape mappedByPlace(Shape shape, double metres) {
    for (Vertex& v : shape.vertices) {
        const dvec3 p = v.position / metres, n = glm::abs(v.normal);
        v.uv = n.y > std::max(n.x, n.z) ? dvec2(p.x, p.z) : n.x > n.z ? dvec2(p.z, -p.y) : dvec2(p.x, -p.y);
    }
    return shape;
}

} // namespace make_scenes
