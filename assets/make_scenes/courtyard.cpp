// SPDX-License-Identifier: MIT
// The default scene: the court of a small house by the sea, in the evening. The sun, a disk, stands to the right behind
// the camera; pale walls and floor receive what pergola, railing, fence, leaves and lantern throw, from nearly touching
// to several metres away.
#include "assets/make_scenes/picture.h"
#include "assets/make_scenes/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace make_scenes {
namespace {

// --- materials -------------------------------------------------------------------------------------------------------

struct Palette {
    int plaster, ochre, stone, clay, roof, floor, azulejo;
    int wood, paleWood, blueWood, iron, brass, bark, water, linen, fruit, glass;
    int leaf, darkLeaf, blossom, geranium;
    int white, azure, sunflower; // cloths
    int scrollwork, lattice;
};

double hash(int x, int y) { // in [0, 1)
    Random random(uint64_t(x * 7919 + y * 104729 + 12345));
    random(0, 1);
    return random(0, 1);
}

// 8 x 8 terracotta tiles, each of its own tone, laid in light mortar.
glm::dvec4 terracotta(double u, double v) {
    const double x = 8 * u, y = 8 * v;
    const int column = int(x) % 8, row = int(y) % 8;
    const double edge = 0.5 - std::max(std::abs(x - std::floor(x) - 0.5), std::abs(y - std::floor(y) - 0.5));
    const double tone = hash(column, row), warmth = hash(column + 31, row);
    const dvec3 tile = glm::mix(dvec3(0.80, 0.66, 0.54), dvec3(0.88, 0.76, 0.65), tone) - dvec3(0, 0.02, 0.05) * warmth;
    return {glm::mix(dvec3(0.80, 0.73, 0.65), tile, glm::smoothstep(0.02, 0.05, edge)), 1};
}

// Blue on white: a star in a ring, a quarter of a flower in each corner.
glm::dvec4 azulejo(double u, double v) {
    const dvec2 p = 2.0 * dvec2(u, v) - 1.0, corner = 1.0 - glm::abs(p);
    const double r = glm::length(p), angle = std::atan2(p.y, p.x), rc = glm::length(corner);
    const bool star = r < 0.33 + 0.16 * std::cos(8 * angle);
    const bool ring = std::abs(r - 0.7) < 0.05;
    const bool flower = rc < 0.42 && rc > 0.18 + 0.06 * std::cos(4 * std::atan2(corner.y, corner.x));
    const bool border = std::max(std::abs(p.x), std::abs(p.y)) > 0.95;
    const dvec3 white(0.93, 0.92, 0.86), blue(0.16, 0.32, 0.62), yellow(0.89, 0.68, 0.25);
    if (r < 0.13) return {yellow, 1};
    return {star || ring || flower ? blue : border ? dvec3(0.75, 0.76, 0.74) : white, 1};
}

glm::dvec4 mask(bool covered) { return {1, 1, 1, covered ? 1 : 0}; }

// Wrought iron: a ring between two hearts of spirals and bars at the sides. v runs downwards.
glm::dvec4 scrollwork(double u, double v) {
    const auto ring = [&](dvec2 centre, double radius, double width) {
        return std::abs(glm::distance(dvec2(u, 1.6 * v), centre) - radius) < width;
    };
    const double side = std::min(u, 1 - u);
    bool iron = side < 0.035 || ring({0.5, 0.8}, 0.2, 0.03) || ring({0.5, 0.8}, 0.07, 0.03);
    for (const double x : {0.27, 0.73})
        for (const double y : {0.34, 1.26}) iron |= ring({x, y}, 0.2, 0.03) || ring({x, y}, 0.09, 0.03);
    iron |= std::abs(u - 0.5) < 0.03 && std::abs(1.6 * v - 0.8) > 0.22;
    return mask(iron);
}

// Crossed laths.
glm::dvec4 lattice(double u, double v) {
    const auto nearWhole = [](double x) { return std::abs(x - std::round(x)) < 0.14; };
    return mask(nearWhole(u + v) || nearWhole(u - v));
}

Palette makePalette(Gltf& gltf) {
    const auto plain = [&](const char* name, dvec3 colour) { return gltf.material({name, colour}); };
    const auto sheet = [&](const char* name, dvec3 colour) {
        return gltf.material({.name = name, .colour = colour, .doubleSided = true});
    };
    const auto textured = [&](const char* name, const std::vector<uint8_t>& png) {
        return gltf.material({.name = name, .texture = gltf.texture(name, png)});
    };
    const auto masked = [&](const char* name, dvec3 colour, const std::vector<uint8_t>& png) {
        return gltf.material({name, colour, gltf.texture(name, png), true, true});
    };
    Palette p{};
    p.plaster = plain("plaster", {0.86, 0.8, 0.69});
    p.ochre = plain("ochre plaster", {0.8, 0.55, 0.3});
    p.stone = plain("stone", {0.72, 0.67, 0.58});
    p.clay = plain("clay", {0.62, 0.29, 0.16});
    p.roof = plain("roof tiles", {0.6, 0.27, 0.15});
    p.floor = textured("terracotta tiles", picture(256, terracotta));
    p.azulejo = textured("azulejos", picture(64, azulejo));
    p.wood = plain("wood", {0.3, 0.17, 0.09});
    p.paleWood = plain("pale wood", {0.52, 0.35, 0.2});
    p.blueWood = plain("blue paint", {0.1, 0.3, 0.42});
    p.iron = plain("iron", {0.06, 0.065, 0.07});
    p.brass = plain("brass", {0.66, 0.45, 0.16});
    p.bark = plain("bark", {0.24, 0.18, 0.13});
    p.water = plain("water", {0.13, 0.36, 0.4});
    p.linen = plain("linen", {0.85, 0.83, 0.78});
    p.fruit = plain("oranges", {0.85, 0.38, 0.05});
    p.glass = plain("window panes", {0.07, 0.1, 0.12});
    p.leaf = sheet("leaves", {0.26, 0.42, 0.1});
    p.darkLeaf = sheet("dark leaves", {0.12, 0.27, 0.09});
    p.blossom = sheet("bougainvillea", {0.72, 0.1, 0.3});
    p.geranium = sheet("geraniums", {0.75, 0.09, 0.06});
    p.white = sheet("white cloth", {0.85, 0.83, 0.78});
    p.azure = sheet("azure cloth", {0.12, 0.36, 0.6});
    p.sunflower = sheet("yellow cloth", {0.85, 0.58, 0.12});
    p.scrollwork = masked("scrollwork", {0.06, 0.065, 0.07}, picture(128, scrollwork));
    p.lattice = masked("lattice", {0.5, 0.36, 0.22}, picture(64, lattice));
    return p;
}

// --- plants ----------------------------------------------------------------------------------------------------------

// Leaves scattered in a ball: kites, widest a third of the way up, folded along their middle. Their outline is
// geometry, not a mask: as cheap to draw as leaves can be, and as crisp from near. Their normals lean outwards, so that
// a crown has a bright and a dark side.
Shape foliage(Random& random, int leaves, double radius, double length, double width = 0.42) {
    Shape shape;
    while (leaves > 0) {
        const dvec3 p(random(-1, 1), random(-1, 1), random(-1, 1));
        const dvec3 direction(random(-1, 1), random(-1, 1), random(-1, 1));
        if (glm::length(p) > 1 || glm::length(p) < 0.35 || glm::length(direction) < 0.2) continue;
        const dvec3 along = glm::normalize(direction + p);
        const dvec3 across = glm::normalize(glm::cross(along, dvec3(0.3, 1, 0.2)));
        const dvec3 side = glm::cross(across, along), up = glm::dot(side, p) < 0 ? -side : side;
        const double size = length * random(0.75, 1.25);
        const dvec3 centre = radius * p * dvec3(1, 0.8, 1);
        const dvec3 foot = centre - 0.5 * size * along, tip = centre + 0.5 * size * along;
        for (const double half : {-0.5, 0.5}) {
            const dvec3 edge = centre + size * (-0.15 * along + half * width * across + 0.12 * up);
            const dvec3 turn = glm::cross(tip - foot, edge - foot), out = glm::dot(turn, up) < 0 ? -turn : turn;
            const dvec3 leaning = glm::normalize(glm::normalize(out) + 0.8 * glm::normalize(p));
            const dvec3 normal = glm::dot(leaning, out) > 0 ? leaning : glm::normalize(out);
            const size_t a = shape.add({foot, normal}), b = shape.add({tip, normal}), c = shape.add({edge, normal});
            out == turn ? shape.triangle(a, b, c) : shape.triangle(a, c, b);
        }
        --leaves;
    }
    return shape;
}

const std::vector<dvec2> potProfile{{0, 0},       {0.19, 0},    {0.27, 0.22}, {0.29, 0.38}, {0.33, 0.4},
                                    {0.33, 0.48}, {0.28, 0.48}, {0.26, 0.4},  {0, 0.4}};
const std::vector<dvec2> jarBody{{0.17, 0},    {0.25, 0.15}, {0.34, 0.33},  {0.39, 0.5},  {0.402, 0.64},
                                 {0.38, 0.79}, {0.31, 0.94}, {0.215, 1.05}, {0.18, 1.12}, {0.225, 1.19}};
const std::vector<dvec2> jarMouth{{0.205, 1.21}, {0.14, 1.12}, {0.1, 1}, {0, 0.95}};

// A profile with a point more in each piece, on a smooth curve (Catmull and Rom) through those given.
std::vector<dvec2> curved(const std::vector<dvec2>& profile) {
    std::vector<dvec2> result;
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
        const dvec2 a = profile[i], b = profile[i + 1];
        const dvec2 before = i > 0 ? profile[i - 1] : a, after = i + 2 < profile.size() ? profile[i + 2] : b;
        result.push_back(a);
        result.push_back((9.0 * (a + b) - before - after) / 16.0);
    }
    result.push_back(profile.back());
    return result;
}

struct Pots { // meshes
    int clay, blue, bush, geranium;
};

Pots makePots(Gltf& gltf, Random& random, const Palette& p) {
    return {.clay = gltf.mesh("pot", {{lathe(potProfile, 24), p.clay}}),
            .blue = gltf.mesh("blue pot", {{lathe(potProfile, 18), p.blueWood}}),
            .bush = gltf.mesh(
                "bush", {{foliage(random, 260, 0.42, 0.15), p.leaf}, {foliage(random, 160, 0.4, 0.15), p.darkLeaf}}),
            .geranium = gltf.mesh("geranium", {{foliage(random, 200, 0.38, 0.13, 0.8), p.darkLeaf},
                                               {foliage(random, 90, 0.42, 0.085, 0.9), p.geranium}})};
}

void addStandingPots(Gltf& gltf, const Pots& pots) {
    struct Place {
        dvec3 at;
        double size;
        bool flowers;
    };
    const std::array<Place, 9> places{{{{0.35, 0, -3.6}, 0.7, false},
                                       {{-4.2, 0.57, 0.92}, 0.62, true}, // on the stairs
                                       {{-4.2, 1.11, 0.11}, 0.62, true},
                                       {{-4.2, 1.65, -0.7}, 0.62, true},
                                       {{-3.72, 2.19, -3.6}, 0.85, false},
                                       {{3.75, 0, -3.55}, 1.0, true},
                                       {{4.5, 0, -0.3}, 1.1, false},
                                       {{-3.75, 0, 2.35}, 1.25, false},
                                       {{-3.95, 0, 3.2}, 0.8, true}}};
    for (size_t i = 0; i < places.size(); ++i) {
        const Place& place = places[i];
        gltf.node("pot", pots.clay, place.at, 0, place.size);
        gltf.node(place.flowers ? "geranium" : "bush", place.flowers ? pots.geranium : pots.bush,
                  place.at + dvec3(0, 0.7 * place.size, 0), 77.0 * double(i), place.size);
    }
}

// Beside the door.
void addStandards(Gltf& gltf, Random& random, const Palette& p, const Pots& pots) {
    const int standard = gltf.mesh("standard", {{foliage(random, 500, 0.42, 0.09), p.leaf},
                                                {foliage(random, 400, 0.4, 0.09), p.darkLeaf},
                                                {rod({0, -1.1, 0}, {0, 0, 0}, 0.025, 10), p.bark}});
    for (const double x : {-2.6, -0.45}) {
        gltf.node("pot", pots.clay, {x, 0, -3.5}, 0, 0.95);
        gltf.node("standard", standard, {x, 1.45, -3.5}, 90 * x);
    }
}

void addFlowersOnSills(Gltf& gltf, const Palette& p, const Pots& pots) {
    const int trough = gltf.mesh("trough", {{boxAround({0, 0.09, 0}, {0.9, 0.18, 0.18}), p.clay}});
    const auto sill = [&](const dvec3& at, double degrees) {
        gltf.node("trough", trough, at, degrees);
        const dvec3 along = dvec3(turned(degrees, {0, 1, 0}) * glm::dvec4(1, 0, 0, 0));
        for (int i = -1; i <= 1; ++i)
            gltf.node("geranium", pots.geranium, at + 0.3 * i * along + dvec3(0, 0.27, 0), 50.0 * i + degrees, 0.55);
    };
    sill({2.5, 2.985, -3.88}, 0);
    sill({-4.38, 2.835, 1.75}, 90);
}

// Below the pergola, and small ones in rings on the west wall.
void addHangingPots(Gltf& gltf, const Palette& p, const Pots& pots) {
    const int chain = gltf.mesh("chain", {{rod({0, 0.35, 0}, {0, 0.9, 0}, 0.008, 6), p.iron}});
    for (const double x : {1.75, 3.3}) {
        const dvec3 at(x, 1.55, -1.85);
        gltf.node("chain", chain, at);
        gltf.node("pot", pots.clay, at, 0, 0.7);
        gltf.node("geranium", pots.geranium, at + dvec3(0, 0.44, 0), 120 * x, 0.85);
    }
    const std::vector<dvec2> onWall{{3.3, 2.6}, {3.9, 2.1},  {3.2, 1.75},  {2.55, 2.15}, {4.5, 2.65},
                                    {4.6, 1.7}, {2.0, 1.65}, {1.15, 2.45}, {0.6, 2.95}}; // z, y
    const int ring = gltf.mesh("pot ring", {{torus(0.17, 0.012, 20, 6), p.iron}});
    for (size_t i = 0; i < onWall.size(); ++i) {
        const dvec3 at(-4.31, onWall[i].y, onWall[i].x);
        gltf.node("pot ring", ring, at + dvec3(0, 0.2, 0));
        gltf.node("pot", pots.blue, at, 0, 0.52);
        gltf.node("geranium", pots.geranium, at + dvec3(0.02, 0.34, 0), 77.0 * double(i), 0.5);
    }
}

void addOilJars(Gltf& gltf, const Palette& p) {
    std::vector<dvec2> profile = curved(jarBody);
    profile.insert(profile.begin(), {0, 0});
    profile.insert(profile.end(), jarMouth.begin(), jarMouth.end());
    const int jar = gltf.mesh("oil jar", {{lathe(profile, 48), p.clay}});
    gltf.node("oil jar", jar, {-2.75, 0, 2.2});
    gltf.node("oil jar", jar, {-2.15, 0, 2.75}, 0, 0.68);
}

// An orange tree behind the fence, whose crown reaches over it.
void addTree(Gltf& gltf, Random& random, const Palette& p) {
    const dvec3 foot(5.75, 0, 3.5);
    const std::array<dvec3, 9> crowns{{{0.1, 3.3, 0.2},
                                       {0.9, 2.9, 0.3},
                                       {-0.85, 3.2, 1.0},
                                       {-0.95, 2.9, -1.1},
                                       {0.5, 2.9, -1.3},
                                       {0.1, 2.75, 1.3},
                                       {-1.75, 2.8, 0.1},
                                       {-0.5, 4.1, -0.5},
                                       {-1.9, 3.3, -0.75}}};
    Shape wood = lathe({{0, 0}, {0.17, 0}, {0.12, 0.25}, {0.1, 0.9}, {0.085, 1.7}, {0, 1.75}}, 14);
    for (const dvec3& crown : crowns) {
        const dvec3 knee(0.35 * crown.x, 2.2, 0.35 * crown.z);
        wood.add(taper({0, 1.5, 0}, knee, 0.05, 0.04, 8));
        wood.add(taper(knee, crown, 0.038, 0.015, 7));
    }
    gltf.node("trunk", gltf.mesh("trunk", {{wood, p.bark}}), foot);
    const int cluster = gltf.mesh(
        "crown", {{foliage(random, 230, 0.55, 0.15), p.leaf}, {foliage(random, 140, 0.52, 0.15), p.darkLeaf}});
    for (size_t i = 0; i < crowns.size(); ++i)
        gltf.node("crown", cluster, foot + crowns[i], 61.0 * double(i), 0.85 + 0.06 * double(i % 4));
    const int orange = gltf.mesh("orange", {{sphere(dvec3(0), 0.06, 12), p.fruit}});
    for (int i = 0; i < 16; ++i) {
        const dvec3 out = glm::normalize(dvec3(random(-1, 1), random(-1, 0.3), random(-1, 1)));
        gltf.node("orange", orange, foot + crowns[size_t(i) % crowns.size()] + 0.5 * out);
    }
}

// --- the house -------------------------------------------------------------------------------------------------------

constexpr double wallTop = 4.65;

// A row of barrel tiles that slope towards +z and end at z = 0, over rafters. Its lower edge is at y = 0.
Shape eaves(double width) {
    std::vector<dvec2> arc;
    for (int i = 0; i <= 8; ++i) arc.push_back({0.1 * std::cos(pi * i / 8), 0.085 * std::sin(pi * i / 8)});
    Shape barrel;
    for (int i = 0; i < 2; ++i)
        barrel.add(prism(arc, 0.75), turned(17, {1, 0, 0}) * moved({0, 0.02 * i, -0.375 - 0.7 * i}));
    Shape shape;
    const int count = int(width / 0.24);
    for (int i = 0; i < count; ++i) shape.add(barrel, moved({-0.5 * width + (i + 0.5) * width / count, 0.02, 0}));
    shape.add(box({-0.5 * width, -0.05, -1.4}, {0.5 * width, 0.02, -0.04}), turned(17, {1, 0, 0}));
    return shape;
}

Shape rafterEnds(double width) {
    Shape shape;
    const int count = int(width / 0.6);
    for (int i = 0; i < count; ++i)
        shape.add(boxAround({-0.5 * width + (i + 0.5) * width / count, -0.1, -0.4}, {0.08, 0.1, 0.6}));
    return shape;
}

void addRoof(Gltf& gltf, const Palette& p) {
    const auto place = [&](const char* name, double width, const dvec3& at, double degrees) {
        gltf.node(name, gltf.mesh(name, {{eaves(width), p.roof}, {rafterEnds(width), p.wood}}), at, degrees);
    };
    place("north eaves", 10.4, {1.1, wallTop + 0.02, -3.5}, 0);
    place("west eaves", 10.4, {-4.0, wallTop + 0.02, 1.15}, 90);
}

// Pane, frame, sill and open shutters, centred on a wall's face.
Shape windowFrame() {
    Shape shape;
    for (const double side : {-1.0, 1.0}) shape.add(boxAround({side * 0.42, 0, 0.04}, {0.08, 1.14, 0.08}));
    shape.add(boxAround({0, 0.61, 0.05}, {0.96, 0.1, 0.1}));
    shape.add(boxAround({0, -0.6, 0.09}, {1.06, 0.07, 0.18}));
    return shape;
}

Shape windowBars() {
    Shape shape;
    shape.add(boxAround({0, 0, 0.03}, {0.05, 1.1, 0.05}));
    shape.add(boxAround({0, 0.16, 0.03}, {0.8, 0.04, 0.04}));
    for (const double side : {-1.0, 1.0}) {
        const double centre = side * 0.72;
        shape.add(boxAround({centre, 0, 0.045}, {0.46, 1.14, 0.03}));
        for (int i = 0; i < 9; ++i) shape.add(boxAround({centre, -0.48 + 0.12 * i, 0.065}, {0.38, 0.05, 0.03}));
    }
    return shape;
}

void addWindows(Gltf& gltf, const Palette& p) {
    const int mesh = gltf.mesh(
        "window",
        {{windowFrame(), p.stone}, {windowBars(), p.blueWood}, {boxAround({0, 0, 0}, {0.8, 1.14, 0.03}), p.glass}});
    gltf.node("window", mesh, {2.5, 3.55, -4});
    gltf.node("window", mesh, {-4.5, 3.4, 1.75}, 90);
}

void addWalls(Gltf& gltf, const Palette& p) {
    gltf.object("floor", mappedByPlace(box({-4.8, -0.3, -4.3}, {6.3, 0, 7}), 3.2), p.floor);

    const double doorway = 3.2; // the width of the bay with the door
    Shape walls;
    walls.add(box({-4.8, 0, -4.3}, {-1.5 - 0.5 * doorway, wallTop, -4}));
    walls.add(archBay(doorway, wallTop, 1.3, 1.75, 0.3, 20), moved({-1.5, 0, -4.15}));
    walls.add(box({-1.5 + 0.5 * doorway, 0, -4.3}, {6.3, wallTop, -4}));
    walls.add(box({-4.8, 0, -4}, {-4.5, wallTop, 7}));
    walls.add(box({5, 0, -4}, {5.3, 0.75, 4.2})); // under the fence
    gltf.object("walls", walls, p.plaster);

    Shape bands; // painted round the foot of the walls
    bands.add(box({-0.6, 0, -4}, {5, 0.55, -3.985}));
    bands.add(box({-3.4, 0, -4}, {-2.4, 0.55, -3.985}));
    bands.add(box({-4.5, 0, 1.6}, {-4.485, 0.55, 7}));
    gltf.object("painted bands", bands, p.ochre);

    Shape door, iron;
    for (int i = 0; i < 6; ++i) door.add(boxAround({-2.05 + 0.22 * i, 1.25, -4.22}, {0.205, 2.5, 0.06}));
    for (const double y : {0.45, 1.6}) iron.add(boxAround({-1.5, y, -4.18}, {1.2, 0.07, 0.03}));
    iron.add(torus(0.07, 0.014, 20, 8), moved({-1.05, 1.1, -4.17}) * turned(90, {1, 0, 0}));
    gltf.object("door", door, p.blueWood);
    gltf.object("door iron", iron, p.iron);
    gltf.object("door step", box({-2.3, 0, -4.28}, {-0.7, 0.1, -3.75}), p.stone);
}

// Twelve steps along the west wall up to a landing on an arch.
constexpr double stairWidth = 1.1, stairRise = 0.18, stairRun = 0.27;
constexpr int stairCount = 12;
constexpr dvec3 stairFoot(-4.5, 0, 1.6); // its left end
constexpr double landing = stairCount * stairRise, tread = 0.03;

void addStairs(Gltf& gltf, const Palette& p) {
    Shape steps, treads, tiles;
    const double left = stairFoot.x, right = left + stairWidth, back = -1.9;
    for (int i = 0; i < stairCount; ++i) {
        const double front = stairFoot.z - stairRun * i, low = stairRise * i;
        steps.add(box({left, low, back}, {right, low + stairRise, front}));
        treads.add(box({left, low + stairRise, i + 1 < stairCount ? front - stairRun : -4.0},
                       {right + 0.02, low + stairRise + tread, front + 0.025}));
        Shape tile;
        tile.quad({left, low, front + 0.003}, {right, low, front + 0.003}, {right, low + stairRise, front + 0.003},
                  {left, low + stairRise, front + 0.003});
        tiles.add(mappedByPlace(tile, stairRise));
    }
    steps.add(box({left, landing - 0.2, -4}, {right, landing, back}));
    steps.add(archBay(2.1, landing - 0.2, 1.4, 0.95, 0.22, 16),
              moved({right - 0.11, 0, -2.95}) * turned(90, {0, 1, 0}));
    gltf.object("stairs", steps, p.plaster);
    gltf.object("treads", treads, p.clay);
    gltf.object("tiles", tiles, p.azulejo);

    Shape upperDoor;
    upperDoor.add(boxAround({-4.49, landing + 1, -2.9}, {0.04, 2, 0.9}));
    gltf.object("upper door", upperDoor, p.blueWood);
    Shape frame;
    for (const double z : {-3.42, -2.38}) frame.add(boxAround({-4.47, landing + 1.03, z}, {0.08, 2.06, 0.14}));
    frame.add(boxAround({-4.46, landing + 2.1, -2.9}, {0.1, 0.14, 1.3}));
    gltf.object("upper door frame", frame, p.stone);
}

// Rails and posts of iron, filled with masked scrollwork.
void addRailing(Gltf& gltf, const Palette& p) {
    Shape iron, panels;
    const double x = stairFoot.x + stairWidth - 0.06, height = 0.92;
    const auto panel = [&](const dvec3& a, const dvec3& b) {
        const dvec3 low(0, 0.1, 0), high(0, height - 0.05, 0);
        panels.quad(a + low, b + low, b + high, a + high);
        iron.add(rod(a + low, b + low, 0.012, 6));
        iron.add(rod(a + dvec3(0, height, 0), b + dvec3(0, height, 0), 0.024, 10));
        iron.add(rod(a, a + dvec3(0, height, 0), 0.014, 8));
    };
    const double bottom = stairFoot.z - 0.1, top = stairFoot.z - stairRun * (stairCount - 1) - 0.1;
    constexpr int sloping = 6, level = 5;
    const auto onSlope = [&](int i) {
        const double t = double(i) / sloping;
        return dvec3(x, glm::mix(stairRise, landing, t), glm::mix(bottom, top, t));
    };
    for (int i = 0; i < sloping; ++i) panel(onSlope(i), onSlope(i + 1));
    const auto onLanding = [&](int i) { return dvec3(x, landing, glm::mix(top, -3.95, double(i) / level)); };
    for (int i = 0; i < level; ++i) panel(onLanding(i), onLanding(i + 1));
    const dvec3 newel = onSlope(0);
    iron.add(rod(newel - dvec3(0, stairRise, 0), newel + dvec3(0, height + 0.08, 0), 0.03, 12));
    Shape knob = sphere(newel + dvec3(0, height + 0.13, 0), 0.06, 20);
    gltf.object("railing", iron, p.iron);
    gltf.object("railing scrollwork", panels, p.scrollwork);
    gltf.object("railing knob", knob, p.brass);
}

void addFence(Gltf& gltf, const Palette& p) {
    Shape net, posts;
    const double x = 5.15, low = 0.75, high = 1.95;
    net.quad({x, low + 0.06, 4}, {x, low + 0.06, -3.9}, {x, high - 0.06, -3.9}, {x, high - 0.06, 4});
    for (Vertex& v : net.vertices) v.uv *= dvec2(26, 4); // the picture repeats every 30 cm
    for (int i = 0; i <= 5; ++i)
        posts.add(boxAround({x, 0.5 * (low + high), -3.9 + 1.58 * i}, {0.08, high - low, 0.08}));
    for (const double y : {low + 0.04, high - 0.02}) posts.add(boxAround({x, y, 0.05}, {0.1, 0.05, 8}));
    gltf.object("fence", posts, p.paleWood);
    gltf.object("fence lattice", net, p.lattice);
}

// --- in the court ----------------------------------------------------------------------------------------------------

void addPergola(Gltf& gltf, Random& random, const Palette& p) {
    const int post = gltf.mesh("post", {{lathe({{0, 0},
                                                {0.22, 0},
                                                {0.22, 0.16},
                                                {0.16, 0.2},
                                                {0.145, 2.2},
                                                {0.2, 2.3},
                                                {0.22, 2.32},
                                                {0.22, 2.42},
                                                {0, 2.42}},
                                               28),
                                         p.plaster}});
    for (const double x : {0.75, 4.35}) gltf.node("post", post, {x, 0, -1.85});
    Shape beams;
    beams.add(boxAround({2.55, 2.5, -1.85}, {4.5, 0.16, 0.14}));
    beams.add(boxAround({2.55, 2.5, -3.93}, {4.5, 0.16, 0.12}));
    for (int i = 0; i < 9; ++i) beams.add(boxAround({0.5 + 0.5125 * i, 2.64, -2.8}, {0.09, 0.13, 2.4}));
    for (int i = 0; i < 3; ++i) beams.add(boxAround({2.55, 2.715, -2.2 - 0.75 * i}, {4.5, 0.03, 0.04}));
    gltf.object("pergola", beams, p.paleWood);

    // A bougainvillea climbs up the right post and spreads.
    const int green = gltf.mesh("vine", {{foliage(random, 190, 0.42, 0.13, 0.6), p.leaf},
                                         {foliage(random, 90, 0.4, 0.13, 0.6), p.darkLeaf},
                                         {foliage(random, 130, 0.45, 0.1, 0.85), p.blossom}});
    const std::array<dvec3, 11> clusters{{{4.5, 0.5, -1.75},
                                          {4.35, 1.0, -1.7},
                                          {4.5, 1.55, -1.8},
                                          {4.4, 2.05, -1.7},
                                          {4.4, 2.6, -1.8},
                                          {3.85, 2.8, -1.75},
                                          {4.55, 2.85, -2.5},
                                          {3.3, 2.72, -1.75},
                                          {4.85, 2.75, -3.2},
                                          {2.85, 2.66, -1.78},
                                          {4.8, 2.2, -2.1}}};
    for (size_t i = 0; i < clusters.size(); ++i)
        gltf.node("vine", green, clusters[i], 47.0 * double(i), i < 4 ? 0.75 : i == 9 ? 0.5 : i == 7 ? 0.75 : 1.0);
    gltf.object("stem", rods({{4.55, 0, -1.7}, {4.5, 0.8, -1.66}, {4.42, 1.7, -1.68}, {4.45, 2.6, -1.75}}, 0.035, 8),
                p.bark);
}

void addTableAndChairs(Gltf& gltf, const Palette& p) {
    const dvec3 place(2.3, 0, -2.75);
    Shape iron;
    for (int i = 0; i < 3; ++i) {
        const double angle = 2 * pi * i / 3 + 0.4;
        const dvec3 out(std::cos(angle), 0, std::sin(angle));
        iron.add(rods({0.36 * out, 0.06 * out + dvec3(0, 0.3, 0), 0.3 * out + dvec3(0, 0.72, 0)}, 0.016, 8));
    }
    gltf.node("table legs", gltf.mesh("table legs", {{iron, p.iron}}), place);
    gltf.node("table", gltf.mesh("table", {{cylinder(0.5, 0.035, 48), p.linen}}), place + dvec3(0, 0.72, 0));
    const dvec3 top = place + dvec3(0, 0.755, 0);
    const int orange = gltf.mesh("fruit", {{sphere({0, 1, 0}, 1, 20), p.fruit}});
    gltf.node("fruit", orange, top + dvec3(0.12, 0, 0.1), 0, 0.042);
    gltf.node("fruit", orange, top + dvec3(0.21, 0, 0.05), 0, 0.038);
    gltf.node("fruit", orange, top + dvec3(0.19, 0, 0.16), 0, 0.04);
    const Shape jug = lathe({{0, 0}, {0.07, 0}, {0.095, 0.08}, {0.09, 0.14}, {0.05, 0.2}, {0.06, 0.27}, {0, 0.26}}, 24);
    gltf.node("jug", gltf.mesh("jug", {{jug, p.blueWood}}), top + dvec3(-0.14, 0, -0.08));

    Shape chair;
    for (const double x : {-0.19, 0.19}) {
        chair.add(rod({x, 0, 0.19}, {x, 0.46, 0.17}, 0.018, 8));
        chair.add(rods({{x, 0, -0.22}, {x, 0.46, -0.18}, {x, 0.92, -0.27}}, 0.018, 8));
        chair.add(rod({x, 0.2, 0.18}, {x, 0.2, -0.2}, 0.011, 6));
    }
    for (int i = 0; i < 5; ++i) chair.add(boxAround({0, 0.47, -0.16 + 0.08 * i}, {0.42, 0.022, 0.06}));
    for (int i = 0; i < 3; ++i) chair.add(boxAround({0, 0.62 + 0.12 * i, -0.215 - 0.02 * i}, {0.4, 0.06, 0.018}));
    const int mesh = gltf.mesh("chair", {{chair, p.blueWood}});
    gltf.node("chair", mesh, place + dvec3(-0.75, 0, 0.15), 75);
    gltf.node("chair", mesh, place + dvec3(0.6, 0, 0.6), -140);
}

void addFountain(Gltf& gltf, const Palette& p) {
    const dvec3 place(-0.9, 0, 0.2);
    const Shape pool = lathe({{0, 0},
                              {1.3, 0},
                              {1.3, 0.14},
                              {1.08, 0.14},
                              {1.08, 0.46},
                              {1.16, 0.48},
                              {1.16, 0.56},
                              {0.9, 0.56},
                              {0.9, 0.4},
                              {0, 0.4}},
                             8);
    const Shape bowl = lathe({{0, 0.3},
                              {0.2, 0.3},
                              {0.2, 0.5},
                              {0.12, 0.56},
                              {0.1, 0.8},
                              {0.12, 0.92},
                              {0.3, 0.98},
                              {0.46, 1.06},
                              {0.54, 1.16},
                              {0.56, 1.22},
                              {0.51, 1.22},
                              {0.46, 1.15},
                              {0.2, 1.08},
                              {0.08, 1.08},
                              {0.06, 1.3},
                              {0.1, 1.38},
                              {0.1, 1.46},
                              {0, 1.52}},
                             40);
    gltf.node("pool", gltf.mesh("pool", {{pool, p.stone}}), place, 22.5);
    gltf.node("bowl", gltf.mesh("bowl", {{bowl, p.stone}}), place);
    gltf.node("water", gltf.mesh("water", {{cylinder(0.98, 0.46, 8), p.water}}), place + dvec3(0, 0.02, 0), 22.5);
    gltf.node("water", gltf.mesh("bowl water", {{cylinder(0.47, 0.03, 32), p.water}}), place + dvec3(0, 1.155, 0));
}

// A line of pennants across the court: what is near the wall throws a sharp shadow on it, what is far a soft one.
void addPennants(Gltf& gltf, const Palette& p) {
    const dvec3 from(-4.5, 3.9, 2.9), to(0.75, 2.62, -1.8);
    const auto onLine = [&](double t) { return glm::mix(from, to, t) - dvec3(0, 1.3 * t * (1 - t), 0); };
    constexpr int pieces = 26;
    std::vector<dvec3> line;
    for (int i = 0; i <= pieces; ++i) line.push_back(onLine(double(i) / pieces));
    gltf.object("line", rods(line, 0.008, 6), p.linen);

    const std::array<int, 4> cloths{p.white, p.blossom, p.azure, p.sunflower};
    std::array<Shape, 4> pennants;
    for (int i = 1; i + 1 < pieces; ++i) {
        const dvec3 middle = 0.5 * (line[size_t(i)] + line[size_t(i) + 1]);
        const dvec3 half = 0.43 * (line[size_t(i) + 1] - line[size_t(i)]);
        const dvec3 drop(0.03 * std::sin(2.0 * i), -0.26, 0.03 * std::cos(3.0 * i));
        Shape& into = pennants[size_t(i) % 4];
        const dvec3 normal = glm::normalize(glm::cross(-half, drop));
        const size_t a = into.add({middle - half, normal}), b = into.add({middle + drop, normal});
        into.triangle(a, b, into.add({middle + half, normal}));
    }
    for (size_t i = 0; i < cloths.size(); ++i) gltf.object("pennants", pennants[i], cloths[i]);
}

// Swings from a bracket on the wall.
void addLantern(Gltf& gltf, const Palette& p) {
    const dvec3 hook(-0.3, 3.95, -3.4);
    Shape bracket;
    bracket.add(boxAround({hook.x, hook.y - 0.1, -3.98}, {0.09, 0.5, 0.05}));
    bracket.add(rod({hook.x, hook.y + 0.08, -3.97}, {hook.x, hook.y + 0.08, hook.z - 0.08}, 0.018, 8));
    std::vector<dvec3> scroll;
    for (int i = 0; i <= 14; ++i) {
        const double t = i / 14.0;
        scroll.push_back(
            {hook.x, hook.y - 0.28 + 0.34 * std::sin(0.5 * pi * t), -3.97 + 0.42 * (1 - std::cos(0.5 * pi * t))});
    }
    bracket.add(rods(scroll, 0.013, 7));
    bracket.add(torus(0.05, 0.01, 16, 7), moved(hook + dvec3(0, 0.03, 0)) * turned(90, {0, 0, 1}));
    gltf.object("bracket", bracket, p.iron);

    Shape lantern;
    lantern.add(rod({0, 0, 0}, {0, -0.42, 0}, 0.008, 7));
    lantern.add(lathe({{0, -0.6}, {0.2, -0.6}, {0.2, -0.585}, {0.06, -0.47}, {0.03, -0.42}, {0, -0.42}}, 6));
    lantern.add(lathe({{0, -1.03}, {0.04, -1.0}, {0.13, -0.98}, {0.13, -0.96}, {0, -0.96}}, 6));
    for (int i = 0; i < 6; ++i) {
        const double angle = pi * i / 3;
        const dvec3 out(std::cos(angle), 0, std::sin(angle));
        lantern.add(rod(0.12 * out - dvec3(0, 0.97, 0), 0.175 * out - dvec3(0, 0.59, 0), 0.011, 6));
    }
    const Shape candle = rod({0, -0.96, 0}, {0, -0.76, 0}, 0.035, 16);
    const int node = gltf.node("lantern", gltf.mesh("lantern", {{lantern, p.iron}, {candle, p.linen}}), hook, 0, 1.25);
    gltf.swing(node, {0.5, 0, 1}, 9, 5);
}

} // namespace

Gltf courtyard() {
    Gltf gltf("courtyard", "Evening sun in a small court: shadows of everything from contact to several metres away.");
    Random random(20);
    const Palette palette = makePalette(gltf);
    addWalls(gltf, palette);
    addWindows(gltf, palette);
    addRoof(gltf, palette);
    addStairs(gltf, palette);
    addRailing(gltf, palette);
    addFence(gltf, palette);
    addPergola(gltf, random, palette);
    addTableAndChairs(gltf, palette);
    addFountain(gltf, palette);
    addTree(gltf, random, palette);
    const Pots pots = makePots(gltf, random, palette);
    addStandingPots(gltf, pots);
    addStandards(gltf, random, palette, pots);
    addFlowersOnSills(gltf, palette, pots);
    addHangingPots(gltf, palette, pots);
    addOilJars(gltf, palette);
    addPennants(gltf, palette);
    addLantern(gltf, palette);
    gltf.camera({.eye = {3.3f, 2.7f, 8.0f}, .target = {-0.5f, 0.88f, -1.5f}, .fovY = 40});
    gltf.light({.shape = penumbra::LightShape::Disk,
                .position = {10.4f, 9.2f, 5.7f},
                .target = {0, 0.8f, -0.5f},
                .size = {0.6f, 0.6f},
                .colour = {1, 0.88f, 0.72f}});
    return gltf;
}

} // namespace make_scenes
