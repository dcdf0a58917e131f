// SPDX-License-Identifier: MIT
// Flows carried out on the GPU: history, repeats, sharing, and times that add up.
#include "renderer/gl/flow_runner.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <chrono>
#include <cstring>
#include <thread>

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
        run();
        return valueOf(image);
    }
    bool inSteps = false; // as small as they get
    void run() {
        if (!inSteps) return runner.run(flow, Timing::Off);
        runner.begin(flow, Timing::Off);
        while (!runner.step(flow, 0)) {
        }
    }
};

Session demo(std::string_view technique) {
    Session s = session(SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).build(), technique);
    s.size = {203, 121}; // no multiples of a group
    return s;
}

std::vector<std::vector<float>> allImages() {
    std::vector<std::vector<float>> images;
    const Flow& flow = renderer().flow();
    for (size_t i = 0; i < flow.images().size(); ++i) {
        const Image image = flow.image(static_cast<int>(i));
        if (flow.spec(image).extent.samples > 1) continue;
        for (int layer = 0; layer < flow.spec(image).extent.layers; ++layer)
            images.push_back(renderer().read(image, layer).values);
    }
    return images;
}

bool sameBits(const std::vector<std::vector<float>>& a, const std::vector<std::vector<float>>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
               return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
           });
}

constexpr Scope a{.instance = "a", .owner = "demo"}, b{.instance = "b", .owner = "demo"};

} // namespace

TEST_CASE("history carries from frame to frame and starts from zero") {
    (void)renderer(); // for its context
    Sums sums;
    sums.inSteps = GENERATE(false, true);
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

TEST_CASE("a pass over tiles runs where they were marked, and nowhere else") {
    (void)renderer();
    Sums sums{.programs = ProgramLibrary(std::filesystem::path(PENUMBRA_SOURCE_FOLDER) / "shaders")};
    constexpr const char *marking = "../tests/techniques/shaders/mark.glsl",
                         *filling = "../tests/techniques/shaders/accumulate.glsl",
                         *running = "../tests/techniques/shaders/over.glsl";
    sums.inSteps = GENERATE(false, true);
    constexpr int width = 43, height = 21; // no multiples of a tile
    for (const bool marks : {true, false, true}) {
        sums.flow.begin();
        const TileSet some = sums.flow.tiles(a, "some", {width, height});
        const ImageSpec sum{"sum", Format::R32F, {width, height}};
        Image image =
            marks ? sums.flow.pass(a, {.name = "mark", .work = Compute{marking}, .writes = {sum}, .marks = {some}})
                  : sums.flow.pass(
                        a, {.name = "fill", .work = Compute{filling}, .writes = {sum}, .constants = Added{{0}}});
        const Image after = sums.flow.pass(
            a, {.name = "over", .work = Compute{running, {}, some}, .onto = {image}, .constants = Added{{4}}});
        CHECK(after == image);
        sums.run();
        const std::vector<float> values = sums.runner.texture(sums.flow, image).read();
        const auto inTile = [&](int x, int y) { return (y == 2 && x / 8 == 1) || (y == 20 && x / 8 == 5); };
        size_t wrong = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                wrong += values[static_cast<size_t>(y * width + x)] !=
                         (marks ? 1.0f : 0.0f) + (marks && inTile(x, y) ? 4 : 0);
        CHECK(wrong == 0);
    }
    CHECK(sums.flow.bytes() == 4 * width * height + 4 * (8 + 2 * 6 * 21 + 8));
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

TEST_CASE("a frame in bands is the same frame bit for bit") {
    for (const Card* card : catalogue()) {
        CAPTURE(card->id);
        Session s = demo(card->id);
        if (Parameter* size = s.techniques.parameters().find("map-size")) size->set(256);
        renderer().render(s);
        const auto whole = allImages();
        for (const double milliseconds : {0.0, 0.5}) {
            s.size.x += 16; // so that no image is what it was by chance
            renderer().render(s);
            s.size.x -= 16;
            renderer().reset();
            renderer().begin(s, Timing::Off);
            size_t steps = 1;
            for (; !renderer().advance(milliseconds); ++steps) CHECK(renderer().underWay());
            CHECK_FALSE(renderer().underWay());
            if (milliseconds == 0) CHECK(steps > 20 * renderer().flow().passes().size());
            CHECK(sameBits(allImages(), whole));
        }
        const auto& passes = renderer().flow().passes();
        for (size_t i = 0; i < passes.size(); ++i)
            if (const Compute* compute = std::get_if<Compute>(&passes[i].work)) {
                CAPTURE(compute->shader);
                CHECK(renderer().runner().programOf(i).bandOrigin() >= 0);
            }
    }
    CHECK(driverMessages().empty());
}

TEST_CASE("a frame under way is of what the session said when it began, and the last picture stays whole") {
    Session s = demo("pcf");
    s.techniques.assign("kernel=3");
    renderer().render(s);
    const auto small = allImages();
    const Texture* const picture = renderer().picture();
    const std::vector<float> shown = picture->read();

    s.techniques.assign("kernel=9");
    s.size += 40;
    renderer().begin(s, Timing::Off);
    for (int i = 0; i < 3; ++i) REQUIRE_FALSE(renderer().advance(0));
    CHECK(renderer().picture() == picture);
    CHECK(picture->read() == shown);
    s.techniques.assign("kernel=3");
    while (!renderer().advance(0)) {
    }
    const auto mixed = allImages();
    s.techniques.assign("kernel=9");
    renderer().reset();
    renderer().render(s);
    CHECK(sameBits(mixed, allImages()));
    CHECK_FALSE(sameBits(mixed, small));

    // Given up for another: nothing of it is left.
    s.techniques.assign("kernel=7"); // nothing is known of its pace, so it goes in bands
    renderer().begin(s, Timing::Queries);
    REQUIRE_FALSE(renderer().advance(0));
    s.techniques.assign("kernel=9");
    renderer().reset();
    renderer().render(s);
    CHECK(sameBits(mixed, allImages()));
}

TEST_CASE("the times of a frame in bands leave out what happened in between") {
    using Clock = std::chrono::steady_clock;
    const auto milliseconds = [](Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); };
    for (const Timing timing : {Timing::Finish, Timing::Queries}) {
        Session s = demo("pcss");
        const Clock::time_point start = Clock::now();
        Clock::duration slept{};
        renderer().begin(s, timing);
        for (int pause = 0; pause < 4; ++pause) { // one band each, however fast the machine
            REQUIRE_FALSE(renderer().advance(0));
            const Clock::time_point before = Clock::now();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            slept += Clock::now() - before;
        }
        while (!renderer().advance(1)) {
        }
        const double wall = milliseconds(Clock::now() - start);
        const PassTimer& timer = renderer().runner().timer();
        if (timing == Timing::Queries) // they come some frames later
            for (int i = 0; i < 2; ++i) renderer().render(s, Timing::Queries);
        CAPTURE(int(timing), wall, milliseconds(slept));
        CHECK(timer.newest().milliseconds > 0);
        if (timing == Timing::Finish) CHECK(timer.newest().milliseconds <= wall - milliseconds(slept));
        double sum = 0;
        for (const PassTime& time : timer.newest().passes) sum += time.milliseconds;
        CHECK(sum == Approx(timer.newest().milliseconds).epsilon(0.05));
        CHECK(timer.newest().passes.size() == renderer().flow().passes().size());
    }
}
