// SPDX-License-Identifier: MIT
// The truth beside a view that goes on: it comes, is refined, goes with the view, and costs nothing where it is off.
#include "renderer/measure/yardstick.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"
#include "tests/truth/closed_forms.h"

#include <chrono>
#include <thread>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// Frames of a window, one after another.
struct Frames {
    Session session = closedFormSession(closedForms[2], {96, 64});
    Yardstick yardstick;
    uint64_t drawn = 0;

    void frame() {
        renderer().render(session);
        yardstick.update(session, renderer(), ++drawn, true);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    template <class Done> bool until(Done&& done) {
        for (int i = 0; i < 6000; ++i) {
            frame();
            if (done()) return true;
        }
        return false;
    }
    bool finished() { return yardstick.truth() && yardstick.truth()->complete && yardstick.errors()[0]; }
};

} // namespace

TEST_CASE("the errors beside a view are those of its ψ against its truth") {
    renderer().reset();
    Frames window;
    for (int i = 0; i < 60; ++i) window.frame();
    CHECK(window.yardstick.truth() == nullptr); // off: no work
    CHECK(window.yardstick.snapshot() == nullptr);
    CHECK(window.session.truth == nullptr);

    window.yardstick.truthWanted = true;
    REQUIRE(window.until([&] { return window.finished(); }));
    for (int i = 0; i < 60; ++i) window.frame(); // the last truth has its errors by now
    const Truth& truth = *window.yardstick.truth();
    const Errors expected = errorsOf(renderer().read(renderer().shadow()).values, truth);
    CHECK(window.yardstick.errors()[0]->all.rmse == expected.all.rmse);
    CHECK(window.yardstick.errors()[0]->penumbra.rmse == expected.penumbra.rmse);
    CHECK(window.yardstick.errors()[0]->share == expected.share);
    CHECK(expected.all.rmse > 0);
    CHECK_FALSE(window.yardstick.errors()[1]);

    // The session's image of it is the same, the other way up.
    REQUIRE(window.session.currentTruth());
    const std::vector<float>& texels = *window.session.currentTruth()->texels;
    REQUIRE(texels.size() == 2 * truth.psi.size());
    bool same = true;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const size_t top = static_cast<size_t>(y * 96 + x), below = static_cast<size_t>((63 - y) * 96 + x);
            same = same && texels[2 * below] == truth.psi[top] &&
                   texels[2 * below + 1] == (truth.classes[top] == PixelClass::FacesWholeLight ? 1.0f : 0.0f);
        }
    CHECK(same);

    // A technique B has errors of its own.
    window.session.comparison.against = Against::Technique;
    window.session.rival.choose("none");
    REQUIRE(window.until([&] { return window.yardstick.errors()[1].has_value(); }));
    CHECK(window.yardstick.errors()[1]->all.rmse ==
          errorsOf(std::vector<float>(truth.psi.size(), 0.0f), truth).all.rmse);
}

TEST_CASE("another view has no truth until its own has come") {
    renderer().reset();
    Frames window;
    window.yardstick.truthWanted = true;
    REQUIRE(window.until([&] { return window.finished(); }));
    const uint64_t hash = window.yardstick.truth()->hash;

    window.session.camera.eye.x += 0.1f;
    CHECK(window.session.currentTruth() == nullptr); // the very next frame does not show it
    window.frame();
    CHECK(window.yardstick.truth() == nullptr);
    CHECK_FALSE(window.yardstick.errors()[0]);
    for (int i = 0; i < 12; ++i) { // while it moves nothing is begun
        window.session.camera.eye.x += 0.001f;
        window.frame();
        CHECK_FALSE(window.yardstick.tracing().running);
    }
    REQUIRE(window.until([&] { return window.finished(); }));
    CHECK(window.yardstick.truth()->hash != hash);

    window.yardstick.cancel(); // what there is stays
    window.frame();
    CHECK(window.yardstick.cancelled());
    CHECK(window.yardstick.truth());
    CHECK(window.session.currentTruth());
    window.yardstick.resume();
    window.yardstick.truthWanted = false;
    window.frame();
    CHECK(window.yardstick.truth() == nullptr);
    CHECK(window.session.truth == nullptr);
}
