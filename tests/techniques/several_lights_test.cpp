// SPDX-License-Identifier: MIT
// Several lights in one picture: each has shadows of its own, and their light adds up.
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

const AreaLight left{.position = {-2, 4, 0}, .colour = {1, 0.6f, 0.4f}},
    right{.position = {2, 4, 1}, .intensity = 0.5f};

Session lit(std::string_view technique, const AreaLight& light, std::vector<FurtherLight> further = {}) {
    Session s = quickSession(SceneBuilder().floor(3).box({-0.4f, 0, -0.4f}, {0.4f, 1, 0.4f}).build(), technique);
    s.light = light;
    s.furtherLights = std::move(further);
    s.display.show = Show::Lit;
    s.display.ambient = 0;
    renderer().reset();
    return s;
}

std::vector<float> image(std::string_view label) {
    const auto found = renderer().flow().find(label);
    REQUIRE(found);
    return renderer().read(*found).values;
}
std::vector<float> shown() { return renderer().read(renderer().shadow()).values; }

void frames(const Session& s, int n) {
    for (int i = 0; i < n; ++i) renderer().render(s);
}
std::vector<float> litFrames(const Session& s, int n) {
    frames(s, n);
    return image("lit");
}

double farthest(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(double(a[i]) - b[i]));
    return most;
}

} // namespace

TEST_CASE("the light of several lights adds up, and none changes the shadow of another") {
    for (const char* technique : {"pcss", "temporal"}) {
        INFO(technique);
        const std::vector<float> ofLeft = litFrames(lit(technique, left), 3);
        const std::vector<float> psi = shown();
        const std::vector<float> ofRight = litFrames(lit(technique, right), 3);
        const std::vector<float> ofBoth = litFrames(lit(technique, left, {{right}}), 3);
        CHECK(shown() == psi);
        std::vector<float> sum(ofLeft.size());
        double added = 0;
        const std::vector<float> depth = renderer().readPicture(renderer().depth()).values;
        for (size_t i = 0; i < sum.size(); ++i) {
            const bool surface = depth[i / 4] > 0 && i % 4 != 3; // else the background and 1
            sum[i] = surface ? ofLeft[i] + ofRight[i] : ofLeft[i];
            added = std::max(added, double(sum[i] - ofLeft[i]));
        }
        CHECK(added > 0.3);
        CHECK(farthest(ofBoth, sum) < 0.002); // half floats
    }
}

TEST_CASE("a light that is off has no buffers, and one that moves begins only its own history anew") {
    Session s = lit("temporal", left, {{right}, {left, false}});
    s.techniques.parameters().at("light-memory").setText("2");
    frames(s, 4);
    CHECK(renderer().flow().find("light-2/temporal.shadow-buffer"));
    CHECK_FALSE(renderer().flow().find("light-3/temporal.shadow-buffer"));
    const auto most = [](std::string_view label) { // samples of a history
        const std::vector<float> buffer = image(label);
        float n = 0;
        for (size_t i = 1; i < buffer.size(); i += 4) n = std::max(n, buffer[i]);
        return n;
    };
    const float before = most("temporal.shadow-buffer");
    s.furtherLights[0].light.position.x += 0.1f;
    frames(s, 1);
    CHECK(most("temporal.shadow-buffer") == before + 1);
    CHECK(most("light-2/temporal.shadow-buffer") == 3);
    s.furtherLights[0].on = false;
    frames(s, 1);
    CHECK_FALSE(renderer().flow().find("light-2/temporal.shadow-buffer"));
    s.furtherLights[0].on = true; // without what it held before
    frames(s, 1);
    CHECK(most("light-2/temporal.shadow-buffer") < before);
    s.comparison = {.against = Against::Technique, .as = CompareAs::Error}; // of the first alone, as is
    frames(s, 1);
    CHECK(renderer().flow().find("a/temporal.shadow-buffer"));
    CHECK_FALSE(renderer().flow().find("a/light-2/temporal.shadow-buffer"));
    s.comparison = {};
    s.display.show = Show::Shadow;
    frames(s, 1);
    CHECK_FALSE(renderer().flow().find("light-2/temporal.shadow-buffer"));
}
