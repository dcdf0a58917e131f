// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "ui/timings_panel.h"

using namespace penumbra;

TEST_CASE("the median window forgets what is older than 60 frames") {
    MedianWindow window;
    CHECK(window.median() == 0);
    window.add(5);
    CHECK(window.median() == 5);
    for (int i = 0; i < 59; ++i) window.add(1);
    window.add(1000); // one slow frame does not show
    CHECK(window.median() == 1);
    for (int i = 0; i < 60; ++i) window.add(2);
    CHECK(window.median() == 2);
}
