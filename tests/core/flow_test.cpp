// SPDX-License-Identifier: MIT
// The pass list as data: no GPU.
#include "renderer/core/flow.h"
#include "tests/catch.h"

using namespace penumbra;

namespace {

constexpr Scope a{.instance = "a", .owner = "demo"}, b{.instance = "b", .owner = "demo"};

ImageSpec image(std::string_view name, int side = 8) { return {name, Format::R32F, {side, side}}; }

struct Block {
    float value[4];
};

PassSpec compute(std::string_view name, float constant = 0, std::initializer_list<Read> reads = {}) {
    PassSpec spec{.name = name, .work = Compute{"demo.glsl"}, .writes = {image(name)}, .constants = Block{{constant}}};
    for (const Read& read : reads) spec.reads.push_back(read);
    return spec;
}

} // namespace

TEST_CASE("labels say instance, owner and image") {
    Flow flow;
    flow.begin();
    const Image one = flow.pass({.instance = {}, .owner = "scene"}, compute("depth"));
    const Image two = flow.pass(a, compute("shadow-map", 1));
    CHECK(flow.label(one) == "scene.depth");
    CHECK(flow.label(two) == "a/demo.shadow-map");
    CHECK(flow.find("a/demo.shadow-map") == two);
    CHECK_FALSE(flow.find("a/demo.shadow").has_value());
}

TEST_CASE("a pass equal to an earlier one runs once and answers to both names") {
    Flow flow;
    flow.begin();
    const Image first = flow.pass(a, compute("shadow-map", 1));
    const Image same = flow.pass(b, compute("shadow-map", 1));
    const Image other = flow.pass(b, compute("other-map", 2));
    CHECK(flow.passes().size() == 2);
    CHECK(same == first);
    CHECK_FALSE(other == first);
    CHECK(flow.find("a/demo.shadow-map") == first);
    CHECK(flow.find("b/demo.shadow-map") == first);
    // What reads different images is different, though its own description is equal.
    const Image blurA = flow.pass(a, compute("blur", 3, {{"map", first}}));
    const Image blurB = flow.pass(b, compute("blur", 3, {{"map", other}}));
    CHECK_FALSE(blurA == blurB);
}

TEST_CASE("two images with one label are a bug that is noticed") {
    Flow flow;
    flow.begin();
    (void)flow.pass(a, compute("shadow-map", 1));
    CHECK_THROWS_AS(flow.pass(a, compute("shadow-map", 2)), std::logic_error);
}

TEST_CASE("a past image is there from the second frame on, for its own instance and description alone") {
    Flow flow;
    const auto frame = [&](Scope scope, int side) {
        const PastImage past = flow.past(scope, image("history", side));
        PassSpec spec = compute("history", 0, {{"past", past}});
        spec.writes = {image("history", side)};
        (void)flow.pass(scope, spec);
        return past.valid();
    };
    flow.begin();
    CHECK_FALSE(frame(a, 8));
    flow.begin();
    CHECK(frame(a, 8));
    CHECK_FALSE(frame(b, 8)); // b starts without a's history
    flow.begin();
    CHECK(frame(a, 8));
    CHECK(frame(b, 8));
    flow.begin();
    CHECK_FALSE(frame(a, 16)); // resized
    flow.begin();
    CHECK(frame(a, 16));
    CHECK_FALSE(frame(b, 8)); // was not drawn last frame
    flow.forget();
    flow.begin();
    CHECK_FALSE(frame(a, 16));
}

TEST_CASE("a past image knows its age, belongs to a key, and may be finished") {
    Flow flow;
    const auto frame = [&](uint64_t key, bool finished = false) {
        flow.begin();
        const PastImage past = flow.past(a, image("history"), key);
        if (finished) flow.finish(past);
        PassSpec spec = compute("history", 0, {{"past", past}});
        spec.writes = {image("history")};
        (void)flow.pass(a, spec);
        return past.age();
    };
    CHECK(frame(1) == 0);
    CHECK(frame(1) == 1);
    CHECK(frame(1) == 2);
    CHECK(flow.living());
    CHECK(frame(2) == 0); // of another view
    CHECK(frame(2, true) == 1);
    CHECK_FALSE(flow.living());
    CHECK(frame(1) == 0);
    CHECK(flow.living());
    flow.forget();
    CHECK(frame(1) == 0);
    flow.begin();
    CHECK_FALSE(flow.living()); // nobody looks back
}

TEST_CASE("a frame again reads the past of the one that it is instead of, unless that is lost") {
    Flow flow;
    const auto frame = [&](Turn turn, uint64_t key = 1) {
        flow.begin(turn);
        const PastImage past = flow.past(a, image("history"), key);
        PassSpec spec = compute("history", 0, {{"past", past}});
        spec.writes = {image("history")};
        (void)flow.pass(a, spec);
        return past.age();
    };
    CHECK(frame(Turn::Again) == 0); // of nothing
    CHECK(flow.historyLength() == 1);
    CHECK(frame(Turn::Next) == 1);
    CHECK(frame(Turn::Next) == 2);
    CHECK(frame(Turn::Again) == 2);
    CHECK(frame(Turn::Again) == 2);
    CHECK(flow.historyLength() == 3);
    CHECK(frame(Turn::Next) == 3);
    CHECK(frame(Turn::Again, 2) == 0); // cannot read it
    CHECK(frame(Turn::Again, 1) == 0); // and nobody can any more
    CHECK(frame(Turn::Next) == 1);
    flow.forget();
    CHECK(frame(Turn::Again) == 0);
    flow.begin(Turn::Again);
    CHECK(flow.historyLength() == 0); // nobody looks back
}

TEST_CASE("a past counts its frames, and the steps that they took") {
    Flow flow;
    const auto frame = [&](int steps, Turn turn = Turn::Next) {
        flow.begin(turn);
        const PastImage past = flow.past(a, image("history"));
        if (steps != 1) flow.advance(past, steps);
        PassSpec spec = compute("history", 0, {{"past", past}});
        spec.writes = {image("history")};
        (void)flow.pass(a, spec);
        return std::pair(past.age(), past.steps());
    };
    CHECK(frame(1) == std::pair(0, 0));
    CHECK(frame(4) == std::pair(1, 1));
    CHECK(frame(2) == std::pair(2, 5));
    CHECK(frame(3, Turn::Again) == std::pair(2, 5)); // instead of it
    CHECK(frame(1) == std::pair(3, 8));
    flow.forget();
    CHECK(frame(1) == std::pair(0, 0));
}

TEST_CASE("a repeat accumulates under one label and forbids reading what is gone") {
    Flow flow;
    flow.begin();
    std::optional<Image> sum, first;
    flow.repeat(4, [&](int i) {
        const Image map = flow.pass(a, compute("map", static_cast<float>(i)));
        if (!first) first = map;
        PassSpec add = compute("sum", static_cast<float>(i), {{"map", map}});
        if (sum) add.reads.push_back({"before", *sum});
        sum = flow.pass(a, add);
    });
    CHECK(flow.passes().size() == 8);
    CHECK(flow.label(*sum) == "a/demo.sum");
    CHECK_NOTHROW(flow.pass(a, compute("mean", 0, {{"sum", *sum}})));
    CHECK_THROWS_AS(flow.pass(a, compute("wrong", 0, {{"map", *first}})), std::logic_error);
    // Two rounds take turns with two textures, however many rounds there are.
    CHECK(flow.bytes() == (2 + 2 + 1) * 8 * 8 * 4);
}

TEST_CASE("bytes are known before anything is allocated, and too many are refused by name") {
    Flow flow;
    flow.begin();
    PassSpec spec = compute("moments");
    spec.writes = {{"moments", Format::RGBA32F, {8192, 8192, 2}}};
    (void)flow.pass(a, spec);
    (void)flow.pass(a, compute("small", 1));
    CHECK(flow.bytes() == 2ull * 8192 * 8192 * 16 + 8 * 8 * 4);
    CHECK_NOTHROW(flow.refuseAbove(uint64_t{4} << 30));
    CHECK_THROWS_WITH(flow.refuseAbove(1 << 30), contains("a/demo.moments 8192x8192x2 RGBA32F = 2048 MiB"));
}

TEST_CASE("the same frame described again allocates no new label and gives the same list") {
    Flow flow;
    for (int frame = 0; frame < 3; ++frame) {
        flow.begin();
        const Image map = flow.pass(a, compute("map", 1));
        (void)flow.pass(a, compute("shadow", 2, {{"map", map}}));
        CHECK(flow.passes().size() == 2);
        CHECK(flow.passes()[1].label == 1);
    }
}
