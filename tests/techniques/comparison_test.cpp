// SPDX-License-Identifier: MIT
// Two shadow images in one picture: each pixel shows the one that belongs there, and neither disturbs the other.
#include "tests/catch.h"
#include "tests/support/scenes.h"

using namespace penumbra;
using namespace penumbra::test;

namespace {

Session compared() {
    Session s = session(SceneBuilder().floor(3).box({-0.5f, 0.5f, -0.5f}, {0.5f, 1, 0.5f}).build(), "pcss");
    s.size = {90, 61};
    s.rival.choose("hard");
    return s;
}

Renderer::Pixels drawn(const Session& session, std::string_view image = "display") {
    renderer().reset();
    renderer().render(session);
    const std::optional<Image> found = renderer().flow().find(image);
    REQUIRE(found);
    return renderer().read(*found);
}

std::vector<float> pixel(const Renderer::Pixels& pixels, int x, int y) {
    const auto at = pixels.values.begin() + static_cast<ptrdiff_t>((y * pixels.width + x) * pixels.channels);
    return {at, at + pixels.channels};
}

// An invented truth: a ramp from left to right, counted in the upper half.
std::shared_ptr<const TruthImage> rampTruth(const Session& s) {
    auto texels = std::make_shared<std::vector<float>>();
    for (int y = 0; y < s.size.y; ++y)
        for (int x = 0; x < s.size.x; ++x) {
            texels->push_back(static_cast<float>(x) / 100);
            texels->push_back(2 * y > s.size.y ? 1.0f : 0.0f);
        }
    return std::make_shared<const TruthImage>(TruthImage{s.truthKey(), texels});
}

} // namespace

TEST_CASE("a wipe, a flip and two pictures side by side show each technique as it is alone") {
    for (const Show shown : {Show::Shadow, Show::Lit}) {
        Session s = compared();
        s.display.show = shown;
        const Renderer::Pixels a = drawn(s);
        std::swap(s.techniques, s.rival);
        const Renderer::Pixels b = drawn(s);
        std::swap(s.techniques, s.rival);
        REQUIRE(a.values != b.values);

        s.comparison.against = Against::Technique;
        s.comparison.line = 0.4f; // 36 of 90 columns
        const Renderer::Pixels wipe = drawn(s);
        s.comparison.exchanged = true;
        const Renderer::Pixels exchanged = drawn(s);
        s.comparison.as = CompareAs::Flip;
        CHECK(drawn(s).values == b.values);
        s.comparison.exchanged = false;
        CHECK(drawn(s).values == a.values);
        s.comparison.as = CompareAs::SideBySide;
        const Renderer::Pixels both = drawn(s);
        REQUIRE((both.width == 180 && both.height == 61));
        bool wipes = true, stands = true;
        for (int y = 0; y < 61; ++y)
            for (int x = 0; x < 90; ++x) {
                wipes = wipes && pixel(wipe, x, y) == pixel(x < 36 ? a : b, x, y) &&
                        pixel(exchanged, x, y) == pixel(x < 36 ? b : a, x, y);
                stands = stands && pixel(both, x, y) == pixel(a, x, y) && pixel(both, 90 + x, y) == pixel(b, x, y);
            }
        CHECK(wipes);
        CHECK(stands);
    }
}

TEST_CASE("two techniques share what they need alike and have names of their own") {
    Session s = compared();
    const std::vector<float> alone = drawn(s, "pcss.shadow").values;
    s.comparison.against = Against::Technique;
    CHECK(drawn(s, "a/pcss.shadow").values == alone);
    CHECK(renderer().flow().find("b/hard.shadow"));
    CHECK(renderer().rival());
    size_t buffers = 0;
    for (const Flow::PassNode& pass : renderer().flow().passes())
        buffers += renderer().flow().label(pass.label) == "scene.geometry-buffer";
    CHECK(buffers == 1);
    // The same technique with the same values costs nothing more.
    const auto passes = [] { return renderer().flow().passes().size(); };
    s.comparison = {};
    (void)drawn(s);
    const size_t once = passes();
    s.comparison = {.against = Against::Technique, .as = CompareAs::Flip};
    s.rival.take(s.techniques.parameters());
    CHECK(drawn(s, "b/pcss.shadow").values == alone);
    CHECK(passes() == once);
}

TEST_CASE("the truth stands beside the technique only in the view that it belongs to") {
    Session s = compared();
    const Renderer::Pixels alone = drawn(s);
    s.truth = rampTruth(s);
    s.comparison = {.against = Against::Truth, .as = CompareAs::Flip, .exchanged = true};
    const Renderer::Pixels shown = drawn(s);
    for (const int x : {0, 17, 89}) // 1 − ψ*, in 8 bits
        CHECK(pixel(shown, x, 5)[0] == Approx(1 - x / 100.0).margin(0.003));
    const Renderer::Pixels truth = drawn(s, "truth.shadow");
    CHECK(pixel(truth, 50, 0) == std::vector<float>{0.5f, 1});
    CHECK(pixel(truth, 50, 60) == std::vector<float>{0.5f, 0});
    // Other texels of the same view take their place.
    auto darker = std::make_shared<std::vector<float>>(*s.truth->texels);
    for (float& value : *darker) value = 1;
    s.truth = std::make_shared<const TruthImage>(TruthImage{s.truthKey(), darker});
    renderer().render(s);
    CHECK(pixel(renderer().read(renderer().display()), 0, 5)[0] == 0);

    s.light.position.x += 0.01f;
    const Renderer::Pixels moved = drawn(s);
    CHECK_FALSE(renderer().flow().find("truth.shadow"));
    s.comparison = {};
    CHECK(drawn(s).values == moved.values);
    CHECK(alone.values != shown.values);
}

TEST_CASE("an error map shows ψ − ψ*: red too dark, blue too light, white right, striped where it does not count") {
    Session s = compared();
    s.truth = rampTruth(s);
    s.comparison = {.against = Against::Truth, .as = CompareAs::Error};
    const Renderer::Pixels error = drawn(s, "compare.error"), map = drawn(s);
    const Renderer::Pixels psi = drawn(s, "pcss.shadow");
    for (int x = 0; x < 90; x += 7) {
        CHECK(pixel(error, x, 10)[0] == Approx(pixel(psi, x, 10)[0] - x / 100.0f).margin(1e-6));
        CHECK(pixel(error, x, 10)[1] == 1);
        CHECK(pixel(error, x, 50)[1] == 0);
        const std::vector<float> uncounted = pixel(map, x, 50);
        CHECK((uncounted[0] == uncounted[1] && uncounted[0] < 0.2f));
    }
    // Lit sky-high pixels are lighter than the ramp: blue, the more so the farther to the right; none at its start.
    CHECK(pixel(map, 0, 2) == std::vector<float>{1, 1, 1, 1});
    CHECK(pixel(map, 80, 2)[2] > pixel(map, 80, 2)[0]);
    CHECK(pixel(map, 80, 2)[0] < pixel(map, 40, 2)[0]);
    s.comparison.gain = 100;
    const Renderer::Pixels strong = drawn(s);
    CHECK(pixel(strong, 5, 2) == pixel(strong, 80, 2)); // −0.05 and −0.8 times 100
    CHECK(pixel(strong, 5, 2)[2] > pixel(strong, 5, 2)[0]);
    // Against itself a technique has no error anywhere.
    s.comparison = {.against = Against::Technique, .as = CompareAs::Error};
    s.rival.take(s.techniques.parameters());
    const Renderer::Pixels none = drawn(s, "compare.error");
    for (size_t i = 0; i < none.values.size(); i += 2) REQUIRE(none.values[i] == 0);
}
