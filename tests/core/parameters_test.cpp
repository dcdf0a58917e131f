// SPDX-License-Identifier: MIT
#include "renderer/core/parameters.h"
#include "tests/catch.h"

#include <bit>
#include <cmath>

using namespace penumbra;

namespace {

enum class Kernel { Box, Gaussian };
constexpr std::string_view kernelNames[] = {"box", "gaussian"};

struct Shared : ParameterGroup {
    explicit Shared(ParameterSet& s) : ParameterGroup(s, "Shared stage") {}
    Choice<Kernel> shape{set, {.id = "shape", .value = 1, .choices = kernelNames}};
    End end{set};
};

struct Parameters : ParameterSet {
    Parameters() { setOwner("demo"); }
    Integer taps{*this, {.id = "filter-taps", .value = 9, .min = 1, .max = 63, .step = 2, .unit = Unit::Texels}};
    Shared shared{*this};
    Real sigma{*this, {.id = "sigma", .label = "Deviation", .symbol = "σ", .value = 2.4, .min = 0.1, .max = 32}};
    Flag on{*this, {.id = "on", .value = 1, .programConstant = true}};
    // As the moment bias does: 2e-6 with a box, 3e-5 with a Gaussian.
    Real alpha{*this,
               {.id = "alpha",
                .min = 0,
                .max = 1e-2,
                .scale = Scale::Logarithmic,
                .smallest = 1e-8,
                .defaultFrom = [](const ParameterSet& s) { return s.at("shape").value() == 0 ? 2e-6 : 3e-5; },
                .active = [](const ParameterSet& s) { return s.at("on").value() != 0; },
                .inactiveReason = "it is off"}};
};

} // namespace

TEST_CASE("a parameter starts at its default and refuses what is outside its range, naming both") {
    Parameters p;
    CHECK(int(p.taps) == 9);
    CHECK(float(p.sigma) == 2.4f);
    CHECK(Kernel(p.shared.shape) == Kernel::Gaussian);
    CHECK_FALSE(p.taps.changed());

    const auto message = [&](Parameter& parameter, double value) {
        try {
            parameter.set(value);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    CHECK(message(p.taps, 65) == "demo.filter-taps: 65 is not in 1..63 texels, odd");
    CHECK(message(p.taps, 8) == "demo.filter-taps: 8 is not in 1..63 texels, odd");
    CHECK(message(p.sigma, 0) == "demo.sigma: 0 is not in 0.1..32");
    CHECK(message(p.sigma, std::nan("")) != "accepted");
    CHECK(message(p.sigma, INFINITY) != "accepted");
    CHECK(message(p.shared.shape, 2) == "demo.shape: 2 is not in box, gaussian");
    CHECK(int(p.taps) == 9); // nothing was lost
    CHECK(message(p.taps, 63) == "accepted");
    CHECK(p.taps.changed());
    p.taps.reset();
    CHECK(int(p.taps) == 9);
}

TEST_CASE("a parameter reads the text that it prints, and nothing else") {
    Parameters p;
    p.sigma.set(0.1);
    for (Parameter* parameter : p.all()) {
        const double before = parameter->value();
        parameter->setText(parameter->text());
        CHECK(parameter->value() == before);
    }
    p.shared.shape.setText("box");
    CHECK(Kernel(p.shared.shape) == Kernel::Box);
    CHECK_THROWS_AS(p.sigma.setText("1.0x"), InputError);
    CHECK_THROWS_AS(p.sigma.setText(""), InputError);
    CHECK_THROWS_AS(p.on.setText("maybe"), InputError);
    CHECK_THROWS_WITH(p.shared.shape.setText("gausian"),
                      "demo.shape: 'gausian' is not in box, gaussian; did you mean 'gaussian'?");
    CHECK_THROWS_WITH(p.at("sigmaa"), "demo has no parameter 'sigmaa'; did you mean 'sigma'?");
}

TEST_CASE("a default may follow other parameters until somebody sets the value") {
    Parameters p;
    CHECK(p.alpha.value() == 3e-5);
    p.shared.shape.set(0);
    CHECK(p.alpha.value() == 2e-6);
    CHECK_FALSE(p.alpha.changed());
    p.alpha.set(1e-3);
    p.shared.shape.set(1);
    CHECK(p.alpha.value() == 1e-3);
    CHECK(p.alpha.changed());
    p.reset();
    CHECK(p.alpha.value() == 3e-5);
}

TEST_CASE("parameters of a shared stage carry its name, the others none") {
    Parameters p;
    CHECK(p.taps.group().empty());
    CHECK(p.shared.shape.group() == "Shared stage");
    CHECK(p.sigma.group().empty());
    CHECK(p.alpha.active());
    p.on.set(0);
    CHECK_FALSE(p.alpha.active());
}

TEST_CASE("the uniform block is what the bytes are") {
    Parameters p;
    CHECK(glslBlock(p) == "#define SHAPE_BOX 0\n#define SHAPE_GAUSSIAN 1\n#define ON 1\n"
                          "layout(std140, binding = 1) uniform Parameters {\n"
                          "    int filterTaps;\n    int shape;\n    float sigma;\n    float alpha;\n};\n");
    std::vector<uint32_t> bytes;
    packBlock(p, bytes);
    REQUIRE(bytes.size() == 4);
    CHECK(bytes[0] == 9);
    CHECK(bytes[1] == 1);
    CHECK(std::bit_cast<float>(bytes[2]) == 2.4f);
    CHECK(std::bit_cast<float>(bytes[3]) == 3e-5f);
}

TEST_CASE("the nearest value is always one that is accepted") {
    Parameters p;
    for (Parameter* parameter : p.all())
        for (const double wish : {-1e30, -1.0, 0.0, 0.3, 7.9, 8.0, 1e30, std::nan("")}) {
            CAPTURE(parameter->spec().id, wish);
            CHECK_NOTHROW(parameter->set(parameter->nearest(wish)));
        }
}

TEST_CASE("names are suggested when they are near and not when they are not") {
    const std::string_view names[] = {"hard", "pcf", "pcss"};
    CHECK(nearestName("pcfs", names) == "pcf");
    CHECK(nearestName("harf", names) == "hard");
    CHECK(nearestName("pfc", names) == "pcf"); // swapped
    CHECK(nearestName("zzzzzz", names).empty());
}
