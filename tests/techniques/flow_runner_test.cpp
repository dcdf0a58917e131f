// SPDX-License-Identifier: MIT
// Flows carried out on the GPU: history, repeats, sharing, and times that add up.
#include "renderer/gl/flow_runner.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

using namespace penumbra;
using namespace penumbra::test;

namespace {

struct Added {
    float value[4];
};

// A flow of passes that add numbers, on shaders of its own.
struct Sums {
    ProgramLibrary programs{std::filesystem::path(PENUMBRA_SOURCE_FOLDER) / "tests/techniques/shaders"};
    FlowRunner runner{programs};
    Flow flow;

    static ImageSpec sum(int side) { return {"sum", Format::R32F, {side, side}}; }
    Image add(Scope scope, float value, int side, std::optional<Read> before) {
        PassSpec pass{
            .name = "sum", .work = Compute{"accumulate.glsl"}, .writes = {sum(side)}, .constants = Added{{value}}};
        if (before) {
            pass.work = Compute{"accumulate.glsl", {{"BEFORE"}}};
            pass.reads.push_back(*before);
        }
        return flow.pass(scope, pass);
    }
    float valueOf(Image image) const { return runner.texture(flow, image).read()[0]; }

    // One frame of a running sum.
    float frame(Scope scope, float value, int side = 8) {
        flow.begin();
        const PastImage past = flow.past(scope, sum(side));
        const Image image = add(scope, value, side, Read{"before", past});
        runner.run(flow, Timing::Off);
        return valueOf(image);
    }
};

constexpr Scope a{.instance = "a", .owner = "demo"}, b{.instance = "b", .owner = "demo"};

} // namespace

TEST_CASE("history carries from frame to frame and starts from zero") {
    (void)renderer(); // for its context
    Sums sums;
    CHECK(sums.frame(a, 1) == 1);
    CHECK(sums.frame(a, 2) == 3);
    CHECK(sums.frame(a, 3) == 6);
    CHECK(sums.frame(a, 1, 16) == 1); // another size: another history
    CHECK(sums.frame(a, 1, 16) == 2);
    sums.flow.forget();
    CHECK(sums.frame(a, 5, 16) == 5);
    CHECK(sums.frame(b, 7, 16) == 7); // another instance
    CHECK(sums.frame(a, 4, 16) == 4); // a was not drawn in between
    CHECK(driverMessages().empty());
}

TEST_CASE("a repeat adds up over its rounds") {
    (void)renderer();
    Sums sums;
    for (const int rounds : {1, 2, 7, 64}) {
        sums.flow.begin();
        std::optional<Image> sum;
        sums.flow.repeat(rounds, [&](int i) {
            sum = sums.add(a, static_cast<float>(i), 8, sum ? std::optional(Read{"before", *sum}) : std::nullopt);
        });
        sums.runner.run(sums.flow, Timing::Finish);
        CAPTURE(rounds);
        CHECK(sums.valueOf(*sum) == static_cast<float>(rounds * (rounds - 1) / 2));
        CHECK(sums.runner.timer().newest().passes.size() == 1); // one row for all rounds
    }
    CHECK(driverMessages().empty());
}

TEST_CASE("a shared image is one texture under both names") {
    (void)renderer();
    Sums sums;
    sums.flow.begin();
    const Image first = sums.add(a, 3, 8, {}), second = sums.add(b, 3, 8, {});
    sums.runner.run(sums.flow, Timing::Off);
    CHECK(first == second);
    CHECK(sums.valueOf(*sums.flow.find("b/demo.sum")) == 3);
}

TEST_CASE("a pass that reads what its shader does not mention, or the other way round, is noticed") {
    (void)renderer();
    Sums sums;
    sums.flow.begin();
    const Image first = sums.add(a, 3, 8, {});
    SECTION("a read too many") {
        (void)sums.add(b, 4, 8, Read{"befour", first});
        CHECK_THROWS_AS(sums.runner.run(sums.flow, Timing::Off), std::logic_error);
    }
    SECTION("a read too few") {
        PassSpec pass{.name = "sum",
                      .work = Compute{"accumulate.glsl", {{"BEFORE"}}},
                      .writes = {Sums::sum(8)},
                      .constants = Added{{1}}};
        (void)sums.flow.pass(b, pass);
        CHECK_THROWS_AS(sums.runner.run(sums.flow, Timing::Off), std::logic_error);
    }
}

TEST_CASE("the passes' times add up to the frame's") {
    Session s = session(SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).build(), "pcf");
    s.size = {640, 480};
    for (int i = 0; i < 3; ++i) renderer().render(s, Timing::Finish);
    const PassTimer& timer = renderer().runner().timer();
    double sum = 0;
    for (const PassTime& time : timer.newest().passes) sum += time.milliseconds;
    CHECK(timer.newest().milliseconds > 0);
    CHECK(sum == Approx(timer.newest().milliseconds).epsilon(0.05));
    CHECK(timer.newest().passes.size() == renderer().flow().passes().size());
}
