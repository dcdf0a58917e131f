// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "renderer/core/slider_scale.h"

using namespace penumbra;

TEST_CASE("a slider's position and its value are inverse to each other") {
    const Spec specs[] = {
        {.id = "linear", .min = -3, .max = 5},
        {.id = "logarithmic", .min = 1e-6, .max = 10, .scale = Scale::Logarithmic},
        {.id = "with-zero", .min = 0, .max = 1, .scale = Scale::Logarithmic, .smallest = 1e-7},
    };
    for (const Spec& spec : specs) {
        CAPTURE(spec.id);
        CHECK(sliderPosition(spec, spec.min) == 0);
        CHECK(sliderPosition(spec, spec.max) == Approx(1));
        CHECK(sliderValue(spec, 0) == spec.min);
        CHECK(sliderValue(spec, 1) == Approx(spec.max));
        double last = sliderValue(spec, 0);
        for (double position = 0.15; position <= 1; position += 0.05) {
            const double value = sliderValue(spec, position);
            CHECK(value > last);
            CHECK(sliderPosition(spec, value) == Approx(position));
            last = value;
        }
    }
}

TEST_CASE("zero is a stop of its own below the smallest value") {
    const Spec spec{.id = "bias", .min = 0, .max = 1, .scale = Scale::Logarithmic, .smallest = 1e-7};
    CHECK(sliderValue(spec, 0) == 0);
    CHECK(sliderValue(spec, 0.02) == 0);
    CHECK(sliderValue(spec, 0.08) == Approx(1e-7));
    CHECK(sliderValue(spec, 0.1) == Approx(1e-7));
    CHECK(sliderPosition(spec, 1e-7) == Approx(0.1));
}

TEST_CASE("every position of a slider means a value in its range") {
    for (const double max : {1e-5, 0.3, 7.0, 1e6})
        for (const Scale scale : {Scale::Linear, Scale::Logarithmic}) {
            const Spec spec{.id = "x", .min = 0, .max = max, .scale = scale, .smallest = max / 1e4};
            for (int i = -10; i <= 110; ++i) {
                const double value = roundForHand(spec, sliderValue(spec, i / 100.0));
                CAPTURE(max, i, value);
                CHECK(value >= 0);
                CHECK(value <= max * 1.001); // rounding may pass the end; Parameter::nearest brings it back
            }
        }
}

TEST_CASE("a hand on a slider leaves short numbers") {
    CHECK(roundForHand({.id = "x", .min = 0, .max = 1}, 0.123456789) == 0.123);
    CHECK(roundForHand({.id = "x", .min = 0, .max = 1000}, 123.456789) == 123);
    const Spec logarithmic{.id = "x", .min = 1e-7, .max = 1, .scale = Scale::Logarithmic};
    CHECK(roundForHand(logarithmic, 3.14159e-5) == 3.14e-5);
    CHECK(roundForHand(logarithmic, 0) == 0);
}
