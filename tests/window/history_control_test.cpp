// SPDX-License-Identifier: MIT
// Freezing, stepping and running to a number of frames, against a technique that counts them.
#include "tests/catch.h"
#include "ui/history_control.h"

using namespace penumbra;

namespace {

struct Window {
    HistoryControl control;
    int length = 0; // of the history
    void frame() {
        const Turn turn = control.next();
        length += turn == Turn::Next || length == 0;
        control.finished(turn, length);
    }
    void frames(int n) {
        for (int i = 0; i < n; ++i) frame();
    }
    void runToTarget() {
        if (control.runToTarget(length)) length = 0;
    }
};

} // namespace

TEST_CASE("a frozen history stands, goes on by as many frames as there were steps, and goes on again") {
    Window window;
    window.frames(5);
    window.control.freeze(true);
    window.frames(3);
    CHECK(window.length == 5);
    CHECK(window.control.frozen());
    window.control.step();
    window.control.step(); // before a frame was drawn
    CHECK(window.control.counting());
    window.frames(7);
    CHECK(window.length == 7);
    CHECK_FALSE(window.control.counting());
    window.control.freeze(false);
    window.frames(2);
    CHECK(window.length == 9);
    window.control.step(); // while it runs it stops
    window.frames(4);
    CHECK(window.length == 9);
}

TEST_CASE("it runs to the frames wanted, anew where there are as many already") {
    Window window;
    window.control.target = 12;
    window.frames(3);
    window.runToTarget();
    window.frames(30);
    CHECK(window.length == 12);
    CHECK(window.control.frozen());
    window.runToTarget();
    window.frame();
    CHECK(window.length == 1);
    window.frames(30);
    CHECK(window.length == 12);
    window.control.target = 13;
    window.runToTarget();
    window.frames(30);
    CHECK(window.length == 13);
    window.runToTarget();
    window.frames(4);
    window.control.step(); // instead of the rest
    window.frames(9);
    CHECK(window.length == 5);
}

TEST_CASE("where nothing keeps a history there is nothing to hold still") {
    HistoryControl control;
    control.freeze(true);
    control.finished(Turn::Again, 0);
    CHECK_FALSE(control.frozen());
    CHECK(control.next() == Turn::Next);
}
