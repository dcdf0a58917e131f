// SPDX-License-Identifier: MIT
// Scenes that show one difficulty each, from a camera that frames it.
#include "assets/make_scenes/scenes.h"

#include <cmath>

namespace make_scenes {

// Scherzer 2009, figure 5. Low slats throw crisp shadows, a high plate a wide penumbra across them: the slats stay
// crisp in it. With the mean depth of both, they blur where it begins.
Gltf overlappingOccluders() {
    Stage s(
        "overlapping-occluders",
        "A high plate's penumbra falls across low slats, whose shadows stay crisp in truth: an averaged blocker depth "
        "blurs them.",
        6);
    Shape slats;
    for (int i = 0; i < 9; ++i) slats.add(boxAround({0.2, 0.35, -1.4 + 0.4 * i}, {4.2, 0.04, 0.09}));
    for (const double x : {-1.8, 2.2}) slats.add(boxAround({x, 0.165, 0.2}, {0.06, 0.33, 3.4}));
    s.gltf.object("slats", slats, s.red);
    s.gltf.object("plate", box({-3.2, 3, -1}, {-0.85, 3.05, 3}), s.blue);
    s.gltf.camera({.eye = {1, 3.5f, 2.9f}, .target = {-0.15f, 0.1f, 0.1f}});
    s.gltf.light({.position = {-1.2f, 6.2f, 3.4f}, .target = {0, 0, 0}, .size = {1.4f, 1.4f}});
    return std::move(s.gltf);
}

// A light larger than its casters: the shadow is penumbra all over, and few samples cannot make it smooth.
Gltf largePenumbra() {
    Stage s("large-penumbra",
            "A light as large as its casters leaves hardly any umbra: few samples show as noise or as bands.", 6);
    s.gltf.object("plate", boxAround({-0.6, 1.3, 0}, {1.5, 0.05, 1.5}), s.red);
    s.gltf.object("ball", sphere({1.35, 0.9, 0.2}, 0.5, 64), s.blue);
    s.gltf.object("pole", rod({0.5, 0, -1.2}, {0.5, 2.4, -1.2}, 0.07, 32), s.grey);
    s.gltf.camera({.eye = {1.2f, 2.3f, 4.6f}, .target = {0.35f, 0.35f, 0}});
    s.gltf.light({.position = {-0.8f, 4.5f, -0.9f}, .target = {0, 0, 0}, .size = {2.4f, 2.4f}});
    return std::move(s.gltf);
}

// Small things on a wide floor, seen from near: a texel of the shadow map is as wide as their feet. Shadows must begin
// where they touch; what a bias lifts detaches them.
Gltf contact() {
    Stage s("contact", "Small things touch a wide floor: a bias that hides acne detaches their shadows from them.", 4);
    s.gltf.object("block", box({-0.34, 0, -0.12}, {-0.2, 0.14, 0.02}), s.red);
    s.gltf.object("pin", lathe({{0, 0}, {0.012, 0}, {0.012, 0.3}, {0, 0.32}}, 32), s.grey);
    s.gltf.object("ball", sphere({0.2, 0.07, 0}, 0.07, 64), s.blue);
    Shape card; // on its edge
    card.add(boxAround({0, 0.06, 0}, {0.15, 0.12, 0.002}), moved({-0.12, 0, 0.16}) * turned(25, {0, 1, 0}));
    s.gltf.object("card", card, s.grey);
    Shape board; // leans on the floor
    board.add(boxAround({0.12, 0.005, 0}, {0.24, 0.01, 0.13}), moved({0.1, 0, 0.2}) * turned(22, {0, 0, 1}));
    s.gltf.object("board", board, s.red);
    Shape coins;
    for (const dvec3 at : {dvec3(-0.31, 0, 0.15), dvec3(-0.25, 0, 0.22), dvec3(0.03, 0, 0.12)})
        coins.add(cylinder(0.027, 0.006, 40), moved(at));
    s.gltf.object("coins", coins, s.blue);
    s.gltf.camera({.eye = {0.17f, 0.31f, 0.66f}, .target = {0.01f, 0.05f, 0.08f}});
    s.gltf.light({.position = {-3, 5, 1.2f}, .target = {0, 0, 0}, .size = {0.6f, 0.6f}});
    return std::move(s.gltf);
}

// A tube of light: edges along it are crisp, edges across it melt away.
Gltf elongated() {
    Stage s(
        "elongated",
        "A long, narrow light: edges along it throw crisp shadows, edges across it melt, and no round or square kernel "
        "does both.",
        6);
    for (const double x : {-1.4, 0.0, 1.4}) {
        const double height = 0.6 + 0.25 * (x + 1.4);
        Shape cross;
        cross.add(boxAround({0, 0, 0}, {0.9, 0.05, 0.09}));
        cross.add(boxAround({0, 0, 0}, {0.09, 0.05, 0.9}));
        s.gltf.node("cross", s.gltf.mesh("cross", {{cross, s.red}}), {x, height, -0.6});
        s.gltf.node("stand", s.gltf.mesh("stand", {{cylinder(0.02, height, 16), s.grey}}), {x, 0, -0.6});
    }
    Shape along, across;
    for (int i = 0; i < 7; ++i) {
        along.add(boxAround({-0.9, 0.35, 0.75 + 0.16 * i}, {1.1, 0.03, 0.06}));
        across.add(boxAround({0.42 + 0.16 * i, 0.35, 1.23}, {0.06, 0.03, 1.02}));
    }
    s.gltf.object("bars along the light", along, s.blue);
    s.gltf.object("bars across the light", across, s.blue);
    s.gltf.camera({.eye = {1.3f, 2.8f, 3.7f}, .target = {0.12f, 0.12f, 0.35f}});
    s.gltf.light({.position = {0, 4.6f, -2.2f}, .target = {0, 0, 0.4f}, .size = {2.2f, 0.08f}});
    return std::move(s.gltf);
}

// Casters thinner than any depth bias ought to be (after Valient 2014's thin occluders): light leaks into a room of
// thin walls where they meet the floor and the lid, and under what lies on the floor.
Gltf thinSlab() {
    Stage s("thin-slab",
            "A dark room of thin walls: a bias, or casting with back faces, lets light in along its edges.", 5.5);
    Shape room; // walls of four millimetres and a lid; inside it is dark
    room.add(box({-0.36, 0, -0.28}, {0.36, 0.36, -0.276}));
    room.add(box({-0.36, 0, -0.276}, {-0.356, 0.36, 0.28}));
    room.add(box({0.356, 0, -0.276}, {0.36, 0.36, 0.28}));
    room.add(box({-0.37, 0.36, -0.29}, {0.37, 0.364, 0.29}));
    s.gltf.object("thin walls", room, s.grey);
    s.gltf.object("slab", box({0.46, 0, 0.1}, {0.72, 0.006, 0.36}), s.red);
    Shape blade;
    blade.add(boxAround({0, 0.08, 0}, {0.24, 0.16, 0.003}), moved({-0.55, 0, 0.2}) * turned(15, {0, 1, 0}));
    s.gltf.object("blade", blade, s.blue);
    s.gltf.camera({.eye = {0.2f, 0.4f, 1.05f}, .target = {0.02f, 0.13f, 0}});
    s.gltf.light({.position = {-2.2f, 5, -3}, .target = {0, 0, 0}, .size = {0.6f, 0.6f}});
    return std::move(s.gltf);
}

// Figure 4 of Valient and de Boer (2006). A long light, a thin board that it grazes, and a bar above it: disks of the
// light's shape around what lies beside the bar's shadow go through the board, whose back then seems to hide the light.
Gltf slantingSlab() {
    Stage s(
        "slanting-slab",
        "A thin board that the light grazes, beside a bar's shadow: a filter that looks around each point takes the "
        "board for its own shadow.",
        6);
    Shape board;
    board.add(boxAround({0, 0, 0}, {1.6, 0.02, 1.6}), moved({0, 0.36, 0}) * turned(25, {0, 0, 1}));
    s.gltf.object("board", board, s.grey);
    Shape bar;
    bar.add(boxAround({0, 0, 0}, {0.3, 0.01, 1.3}), moved({0.7, 1.16, -0.65}) * turned(-42, {0, 0, 1}));
    s.gltf.object("bar", bar, s.red);
    s.gltf.camera({.eye = {-0.6f, 2.5f, 2.5f}, .target = {0.15f, 0.4f, -0.15f}});
    s.gltf.light({.position = {2.6f, 3.26f, 0}, .target = {0, 0.36f, 0}, .size = {0.08f, 0.9f}});
    return std::move(s.gltf);
}

// Bars hang far above a screen whose shadow covers theirs. A filter of depths sees a spread that no single caster
// explains (Chebyshev's bound: up to half of the light at the screen's foot) and draws the bars' edges in light.
Gltf twoDepths() {
    Stage s("two-depths",
            "Bars far above a screen: in its shadow theirs must not show, but filters of depths let light bleed along "
            "their edges.",
            6);
    s.gltf.object("screen", box({-1.6, 0, -0.55}, {1.6, 1.6, -0.5}), s.red);
    Shape bars;
    for (int i = 0; i < 4; ++i) bars.add(boxAround({-1.05 + 0.7 * i, 3.6, -2.7}, {0.3, 0.05, 1.8}));
    s.gltf.object("bars", bars, s.blue);
    s.gltf.camera({.eye = {1.3f, 2.9f, 4.4f}, .target = {0, 0.55f, 0}});
    s.gltf.light({.position = {0.2f, 6, -4.8f}, .target = {0, 0, 0}, .size = {0.5f, 0.5f}});
    return std::move(s.gltf);
}

// A shape that floats over stairs (Peters 2015): the receiver's depth jumps inside of one filter kernel.
Gltf overStairs() {
    Stage s("over-stairs", "Shapes float over stairs: the receiver's depth jumps inside of every filter kernel.", 6);
    Shape stairs;
    for (int i = 0; i < 10; ++i) stairs.add(box({-2.5, 0, -2.5 + 0.4 * i}, {2.5, 0.2 * (10 - i), -2.1 + 0.4 * i}));
    s.gltf.object("stairs", stairs, s.grey);
    Shape ring;
    ring.add(torus(0.8, 0.12, 96, 24), moved({-0.9, 3, 0}) * turned(25, {1, 0, 0}));
    s.gltf.object("ring", ring, s.red);
    Shape star;
    for (int i = 0; i < 3; ++i)
        star.add(boxAround(dvec3(0), {1.7, 0.06, 0.16}), moved({1.2, 3, 0}) * turned(60 * i + 10, {0, 1, 0}));
    s.gltf.object("star", star, s.blue);
    s.gltf.camera({.eye = {2, 4.6f, 5}, .target = {0, 1.45f, -0.2f}});
    s.gltf.light({.position = {-1, 8, 3.4f}, .target = {0, 1, 0}, .size = {0.8f, 0.8f}});
    return std::move(s.gltf);
}

// What keeps its history must let go of it: a sliding box, a turning bar, and a pillar that stands still.
Gltf movingCaster() {
    Stage s("moving-caster", "Shadows of a fan and a sliding box move fast: what keeps a history drags it behind them.",
            5);
    s.gltf.object("pillar", box({-0.2, 0, -1.5}, {0.2, 1.2, -1.1}), s.grey);
    const int slider = s.gltf.object("slider", boxAround({0, 0.75, 1}, {0.5, 0.5, 0.5}), s.red);
    s.gltf.animate(slider, "translation", {0, 1, 2}, {-1.6, 0, 0, 1.6, 0, 0, -1.6, 0, 0});
    Shape fan = cylinder(0.14, 0.12, 32);
    for (int i = 0; i < 3; ++i) fan.add(boxAround({0.7, 0.06, 0}, {1.2, 0.04, 0.24}), turned(120 * i, {0, 1, 0}));
    s.gltf.spin(s.gltf.node("fan", s.gltf.mesh("fan", {{fan, s.blue}}), {0, 1.5, -0.5}), 2);
    s.gltf.camera({.eye = {1.5f, 3.1f, 3.7f}, .target = {0, 0.5f, 0.1f}});
    s.gltf.light({.position = {-1.2f, 5.5f, 0.4f}, .target = {0, 0, 0}, .size = {0.7f, 0.7f}});
    return std::move(s.gltf);
}

} // namespace make_scenes
