// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "renderer/core/background_work.h"

#include <chrono>
#include <stdexcept>

using namespace penumbra;

namespace {

template <class Result> std::optional<Result> await(BackgroundWork<Result>& work) {
    while (work.progress()) {
        if (std::optional<Result> result = work.poll()) return result;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::nullopt;
}

// Goes on until it is cancelled.
int endless(Progress& progress) {
    for (;;) {
        progress.report("working", 0.5);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace

TEST_CASE("work in the background brings its result once, or what it threw") {
    BackgroundWork<std::unique_ptr<int>> work;
    CHECK_FALSE(work.progress());
    work.start([number = std::make_unique<int>(7)](Progress&) mutable { return std::move(number); });
    const auto result = await(work);
    REQUIRE(result);
    CHECK(**result == 7);
    CHECK_FALSE(work.progress());
    CHECK_FALSE(work.poll());
    work.start([](Progress&) -> std::unique_ptr<int> { throw std::runtime_error("no"); });
    CHECK_THROWS_WITH(await(work), "no");
    CHECK_FALSE(work.progress());
}

TEST_CASE("work in the background can be stopped, dropped and replaced") {
    BackgroundWork<int> work;
    work.start(endless);
    work.stop();
    CHECK_FALSE(await(work)); // it had nothing to give
    work.start([](Progress& progress) {
        try {
            return endless(progress);
        } catch (const Cancelled&) {
            return 3;
        }
    });
    work.stop();
    CHECK(await(work) == 3);
    work.start(endless);
    work.start([](Progress&) { return 5; });
    CHECK(await(work) == 5);
    work.start(endless); // ends with its owner
}
