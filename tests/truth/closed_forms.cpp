// SPDX-License-Identifier: MIT
#include "tests/truth/closed_forms.h"

#include <algorithm>
#include <cmath>

namespace penumbra::test {
namespace {

constexpr double H = 10, lightHalf = 0.5;

// What the slab [low, high] x [bottom, top] hides of the light's line, seen from x on the floor: each side of the slab
// seen at whichever of its two edges reaches farther.
struct Interval {
    double from, to;
    bool contains(double x) const { return from < x && x < to; }
    double share() const { // of the light
        return std::max(0.0, std::min(to, lightHalf) - std::max(from, -lightHalf)) / (2 * lightHalf);
    }
};
Interval hidden(double x, double low, double high, double bottom, double top) {
    const auto onLight = [&](double edge, double height) { return x + (edge - x) * H / height; };
    return {std::min(onLight(low, bottom), onLight(low, top)), std::max(onLight(high, bottom), onLight(high, top))};
}
Interval slab(glm::dvec3 p) { return hidden(p.x, -5, 0, 5.99, 6); }
Interval plateX(glm::dvec3 p) { return hidden(p.x, -0.6, 0.6, 5.998, 6); }
Interval plateZ(glm::dvec3 p) { return hidden(p.z, -0.4, 0.4, 5.998, 6); }

} // namespace

double halfPlanePsi(glm::dvec3 p) { return slab(p).share(); }
bool halfPlaneHides(glm::dvec3 p, glm::dvec2 onLight) { return slab(p).contains(onLight.x); }

double rectanglePsi(glm::dvec3 p) { return plateX(p).share() * plateZ(p).share(); }
bool rectangleHides(glm::dvec3 p, glm::dvec2 onLight) {
    return plateX(p).contains(onLight.x) && plateZ(p).contains(onLight.y);
}

bool sphereHides(glm::dvec3 p, glm::dvec2 onLight) {
    const glm::dvec3 c = glm::dvec3(0, 6, 0) - p, d = glm::dvec3(onLight.x, H, onLight.y) - p;
    return (glm::dot(c, c) - 0.6 * 0.6) * glm::dot(d, d) < glm::dot(c, d) * glm::dot(c, d);
}

// A ray from P along D passes the sphere around C at a distance below R where
//     (|c|² − R²) |D|² < (c·D)²,  c = C − P,
// quadratic in one coordinate of the light's point; the disk is cut into strips along it.
double sphereUnderDisk(double r, double R, double lightHeight, double h, glm::dvec2 place) {
    constexpr int strips = 4000;
    const glm::dvec3 c(-place.x, h, -place.y);
    const double k = glm::dot(c, c) - R * R;
    double area = 0;
    for (int i = 0; i < strips; ++i) {
        const double angle = M_PI * ((i + 0.5) / strips - 0.5);
        const double x = r * std::sin(angle), half = r * std::cos(angle), width = half * M_PI / strips;
        // D = (x − place.x, H, z − place.y) = a + z e_z
        const glm::dvec3 a(x - place.x, lightHeight, -place.y);
        // A z² + 2 B z + C < 0
        const double A = k - c.z * c.z, B = k * a.z - glm::dot(c, a) * c.z,
                     C = k * glm::dot(a, a) - glm::dot(c, a) * glm::dot(c, a);
        const double root = B * B - A * C;
        if (root <= 0) continue;
        const double low = (-B - std::sqrt(root)) / A, high = (-B + std::sqrt(root)) / A;
        area += width * std::max(0.0, std::min(high, half) - std::max(low, -half));
    }
    return area / (M_PI * r * r);
}

double spherePsi(glm::dvec3 p) { return sphereUnderDisk(lightHalf, 0.6, H, 6, {p.x, p.z}); }

Session closedFormSession(const ClosedForm& form, glm::ivec2 size) {
    Session s;
    s.setScene(std::make_shared<const Scene>(importGltf(findScene(form.scene))));
    s.display.show = Show::Shadow;
    s.size = size;
    return s;
}

bool onKnownFloor(glm::vec3 p) { return std::abs(p.y) < 1e-3f && std::abs(p.z) < 3 && std::abs(p.x) < 3; }

} // namespace penumbra::test
