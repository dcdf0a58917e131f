// SPDX-License-Identifier: MIT
// Images with known texels, looked into on the GPU.
#include "tests/catch.h"
#include "tests/numerics/glsl_cpp.h"
#include "tests/support/scenes.h"

#include "renderer/inspect/inspector.h"

#include <array>
#include <limits>
#include <numeric>
#include <random>

using namespace penumbra;
using namespace penumbra::test;
using glm::ivec2;

namespace {

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Inspector& inspector() {
    static Inspector made(renderer().programs());
    return made;
}

// From texels whose first row is the upper one.
Texture image(Format format, Extent extent, const std::vector<float>& texels, int layer = 0, int level = 0) {
    (void)renderer(); // for its context
    Texture texture("test", format, extent);
    const size_t row =
        static_cast<size_t>(std::max(extent.width >> level, 1)) * static_cast<size_t>(info(format).channels);
    std::vector<float> upward;
    for (size_t end = texels.size(); end > 0; end -= row)
        upward.insert(upward.end(), texels.begin() + static_cast<ptrdiff_t>(end - row),
                      texels.begin() + static_cast<ptrdiff_t>(end));
    const GlFormat gl = glFormat(format);
    const int width = std::max(extent.width >> level, 1), height = std::max(extent.height >> level, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (extent.layers > 1)
        glTextureSubImage3D(texture.name(), level, 0, 0, layer, width, height, 1, gl.layout, gl.type, upward.data());
    else
        glTextureSubImage2D(texture.name(), level, 0, 0, width, height, gl.layout, gl.type, upward.data());
    return texture;
}

Statistics measured(const Source& source, int channel, ValueRange domain) {
    Statistics statistics;
    for (int turn = 0; turn < Inspector::turns(source); ++turn)
        inspector().measure(source, channel, domain, turn, statistics);
    return statistics;
}

int64_t sum(std::span<const uint32_t> bins) { return std::accumulate(bins.begin(), bins.end(), int64_t{0}); }

// 8-bit RGBA of every pixel, upper row first.
std::vector<std::array<int, 4>> painted(const Source& source, const Look& look, const ImageWindow& window, ivec2 size) {
    const Texture target("target", Format::RGBA8, {.width = size.x, .height = size.y});
    inspector().paint(source, look, window, target, {0, 0}, size);
    const std::vector<float> values = target.read();
    std::vector<std::array<int, 4>> pixels;
    for (size_t i = 0; i < values.size(); i += 4) {
        const auto byte = [&](size_t c) { return static_cast<int>(std::lround(255 * values[i + c])); };
        pixels.push_back({byte(0), byte(1), byte(2), byte(3)});
    }
    return pixels;
}

constexpr std::array<int, 4> outside{0, 0, 0, 0}, magenta{255, 0, 255, 255}, cyan{0, 255, 255, 255},
    blue{64, 128, 255, 255}, orange{255, 115, 0, 255};
constexpr std::array<int, 4> grey(int v) { return {v, v, v, 255}; }

constexpr Channel unitChannel[] = {{"x", "", "", Unit::None, 0, 1}};

} // namespace

TEST_CASE("marked texels are counted, and the first of each kind is found") {
    const Texture texture =
        image(Format::R32F, {.width = 4, .height = 3},
              {0, 1, 0.5f, 2, -1, notANumber, infinity, -infinity, -0.25f, notANumber, 0.25f, 0.75f});
    const Statistics s = measured({texture, unitChannel}, 0, {0, 1});
    CHECK(s.complete());
    CHECK(s.texels() == 12);
    CHECK(s.count(Mark::NaN) == 2);
    CHECK(s.count(Mark::Infinite) == 2);
    CHECK(s.count(Mark::Negative) == 2);
    CHECK(s.count(Mark::OutOfRange) == 3);
    CHECK(s.first(Mark::NaN) == ivec2(1, 1));
    CHECK(s.first(Mark::Infinite) == ivec2(2, 1));
    CHECK(s.first(Mark::Negative) == ivec2(0, 1));
    CHECK(s.first(Mark::OutOfRange) == ivec2(3, 0));
    CHECK(s.extremes() == ValueRange{-1, 2});
    CHECK(sum(s.bins(0)) == 5);
    CHECK(s.measured.below[0] == 2);
    CHECK(s.measured.above[0] == 1);
    CHECK(s.bins(0)[0] == 1);
    CHECK(s.bins(0)[histogramBins / 2] == 1);
    CHECK(s.bins(0)[histogramBins - 1] == 1); // the upper end belongs to the last bin

    const Statistics unstated = measured({texture, {}}, 0, {0, 1});
    CHECK(unstated.count(Mark::OutOfRange) == 0);
    CHECK_FALSE(unstated.first(Mark::OutOfRange));
    CHECK(driverMessages().empty());
}

TEST_CASE("a texel counts once, and bad numbers in channels that are not shown are told apart") {
    const Texture texture = image(Format::RGBA32F, {.width = 2, .height = 2},
                                  {notANumber, notANumber, 0, 0, //
                                   0, 0, 0, infinity,            //
                                   -1, -2, -3, 0,                //
                                   1, 2, 3, 4});
    const Statistics together = measured({texture, {}}, -1, {-4, 4});
    CHECK(together.channels == 3);
    CHECK(together.count(Mark::NaN) == 1);
    CHECK(together.count(Mark::Negative) == 1);
    CHECK(together.measured.elsewhere == 1); // in the alpha channel
    CHECK(together.extremes() == ValueRange{-3, 3});
    for (int c = 0; c < 3; ++c) CHECK(sum(together.bins(c)) == (c < 2 ? 3 : 4));

    const Statistics alpha = measured({texture, {}}, 3, {0, 4});
    CHECK(alpha.count(Mark::Infinite) == 1);
    CHECK(alpha.count(Mark::NaN) == 0);
    CHECK(alpha.measured.elsewhere == 1);
    CHECK(alpha.extremes() == ValueRange{0, 4});
}

TEST_CASE("a large image is counted in turns, at last to the texel") {
    constexpr int width = 1537, height = 1201;
    std::vector<float> texels(static_cast<size_t>(width) * height);
    std::mt19937 random(5);
    int64_t nan = 0, negative = 0, below = 0;
    for (float& v : texels) {
        v = std::uniform_real_distribution<float>(-0.1f, 1)(random);
        if (random() % 1000 == 0) v = notANumber;
        nan += std::isnan(v);
        negative += v < 0;
        below += v < 0.5f;
    }
    const Texture texture = image(Format::R32F, {.width = width, .height = height}, texels);
    const Source source{texture, {}};
    const int turns = Inspector::turns(source);
    CHECK(turns == 4);
    Statistics s;
    for (int turn = 0; turn < turns; ++turn) {
        CHECK((turn == 0 || !s.complete()));
        const int64_t before = s.measured.looked;
        inspector().measure(source, 0, {0.5f, 1}, turn, s);
        CHECK(s.measured.looked - before <= Inspector::mostTexelsAtOnce);
    }
    CHECK(s.complete());
    CHECK(s.count(Mark::NaN) == nan);
    CHECK(s.count(Mark::Negative) == negative);
    CHECK(s.measured.below[0] == below);
    CHECK(sum(s.bins(0)) == int64_t{width} * height - nan - below);
}

TEST_CASE("the automatic range of an image comes from texels all over it") {
    constexpr int width = 1000, height = 500;
    std::vector<float> texels;
    std::mt19937 random(7);
    for (int i = 0; i < width * height; ++i) {
        const float uniform = std::uniform_real_distribution<float>(0, 100)(random);
        texels.push_back(-1);
        texels.push_back(i % 50 == 0 ? notANumber : i % 51 == 0 ? infinity : uniform);
    }
    const Texture texture = image(Format::RG32F, {.width = width, .height = height}, texels);
    const auto range = inspector().range({texture, {}}, 1);
    REQUIRE(range);
    // 16384 samples: the 1st percentile has a standard deviation of 0.08.
    CHECK(range->min == Approx(1).margin(0.35));
    CHECK(range->max == Approx(99).margin(0.35));
    CHECK(*inspector().range({texture, {}}, 0) == ValueRange{-1, -1});

    // Columns that alternate: no lattice of every n-th texel may miss half of them.
    for (size_t i = 0; i < texels.size(); i += 2) texels[i] = static_cast<float>(i / 2 % 2);
    const Texture stripes = image(Format::RG32F, {.width = width, .height = height}, texels);
    CHECK(*inspector().range({stripes, {}}, 0) == ValueRange{0, 1});

    const Texture small = image(Format::R32F, {.width = 3, .height = 2}, {5, 1, 4, 2, 6, 3});
    CHECK(*inspector().range({small, {}}, 0) == ValueRange{1, 6});
    const Texture nothing = image(Format::R32F, {.width = 1, .height = 1}, {notANumber});
    CHECK_FALSE(inspector().range({nothing, {}}, 0));
}

TEST_CASE("an image is painted upright: grey, colours, the outside") {
    const Texture texture = image(Format::R32F, {.width = 3, .height = 2}, {0, 0.5f, 1, 0.25f, 2, -7});
    const auto pixels = painted({texture, {}}, {}, {-1, 0, 1}, {5, 2});
    CHECK(pixels == std::vector{outside, grey(0), grey(128), grey(255), outside, //
                                outside, grey(64), grey(255), grey(0), outside});
    // Two and a half pixels a texel, from the middle of the first one.
    const auto large = painted({texture, {}}, {}, {0.5, 1, 0.4}, {6, 1});
    CHECK(large == std::vector{grey(64), grey(255), grey(255), grey(255), grey(0), grey(0)});

    const Texture colours = image(Format::RGBA32F, {.width = 2, .height = 1}, {1, 0.5f, 0, 9, 0, 0, 1, 9});
    CHECK(painted({colours, {}}, {.channel = -1}, {}, {2, 1}) ==
          std::vector<std::array<int, 4>>{{255, 128, 0, 255}, {0, 0, 255, 255}});
    CHECK(painted({colours, {}}, {.channel = 3, .range = {0, 18}}, {}, {1, 1})[0] == grey(128));

    // Only the rectangle of the target is painted.
    const Texture target("target", Format::RGBA8, {.width = 4, .height = 4});
    inspector().paint({texture, {}}, {}, {2, 0, 1}, target, {0, 0}, {4, 4});
    inspector().paint({texture, {}}, {}, {2, 0, 1}, target, {1, 2}, {1, 1});
    const std::vector<float> values = target.read();
    const auto red = [&](size_t x, size_t y) { return values[4 * (4 * y + x)]; };
    CHECK(red(0, 0) == 1);
    CHECK(red(1, 2) == 1);
    CHECK(red(2, 2) == 0);
}

TEST_CASE("marks are painted over the colours where they are asked for") {
    const Texture texture =
        image(Format::R32F, {.width = 6, .height = 1}, {notANumber, infinity, -infinity, -0.5f, 1.5f, 0.5f});
    Look look;
    look.marks = 0;
    CHECK(painted({texture, unitChannel}, look, {}, {6, 1})[5] == grey(128));
    CHECK(painted({texture, unitChannel}, look, {}, {6, 1})[3] == grey(0));
    look.marks = badNumbers;
    CHECK(painted({texture, unitChannel}, look, {}, {6, 1}) ==
          std::vector{magenta, cyan, cyan, grey(0), grey(255), grey(128)});
    look.marks = bit(Mark::Negative);
    CHECK(painted({texture, unitChannel}, look, {}, {6, 1})[3] == blue);
    look.marks = bit(Mark::OutOfRange);
    CHECK(painted({texture, unitChannel}, look, {}, {6, 1})[3] == orange);
    CHECK(painted({texture, unitChannel}, look, {}, {6, 1})[4] == orange);
    CHECK(painted({texture, {}}, look, {}, {6, 1})[4] == grey(255)); // nothing is stated
    for (size_t mark = 0; mark < 4; ++mark) {                        // the legend has the picture's colours
        look.marks = static_cast<Marks>(1 << mark);
        const auto pixel = painted({texture, unitChannel}, look, {}, {6, 1})[mark == 0 ? 0 : mark == 1 ? 1 : 3];
        for (size_t c = 0; c < 3; ++c) CHECK(pixel[c] == static_cast<int>(std::lround(255 * markColours[mark][c])));
    }
}

TEST_CASE("colour maps are those of the library, over a range of any width") {
    constexpr int width = 9;
    std::vector<float> texels;
    for (int i = 0; i < width; ++i) texels.push_back(static_cast<float>(i - 4));
    const Texture texture = image(Format::R32F, {.width = width, .height = 1}, texels);
    const auto near = [](std::array<int, 4> pixel, glm::dvec3 colour) {
        for (int c = 0; c < 3; ++c)
            CHECK(pixel[static_cast<size_t>(c)] == Approx(255 * std::min(colour[c], 1.0)).margin(0.6));
    };
    const auto map = [&](ColourMap wanted, ValueRange range) {
        return painted({texture, {}}, {.range = range, .map = wanted}, {}, {width, 1});
    };
    for (size_t i = 0; i < width; ++i) {
        const double v = texels[i];
        CAPTURE(v);
        near(map(ColourMap::Viridis, {-4, 4})[i], f64::viridis((v + 4) / 8));
        near(map(ColourMap::Diverging, {-4, 4})[i], f64::diverging(v / 4));
        near(map(ColourMap::Diverging, {-1, 8})[i], f64::diverging(v / 8)); // zero stays white
        near(map(ColourMap::Flags, {0, 1})[i], f64::flagColour(v));
    }
    const float most = std::numeric_limits<float>::max();
    const Texture wide = image(Format::R32F, {.width = 3, .height = 1}, {-most, 0, most});
    CHECK(painted({wide, {}}, {.range = {-most, most}}, {}, {3, 1}) == std::vector{grey(0), grey(128), grey(255)});
}

TEST_CASE("layers, mip levels, samples and depth are looked at one by one") {
    const Extent array{.width = 4, .height = 2, .layers = 3, .levels = 2};
    const Texture layers = image(Format::R16F, array, {1, 2, 3, 4, 5, 6, 7, 8}, 2);
    std::vector<float> values;
    inspector().read({layers, {}, 2}, {1, 0}, {2, 2}, values);
    CHECK(values == std::vector<float>{2, 3, 6, 7});
    CHECK(measured({layers, {}, 2}, 0, {0, 8}).extremes() == ValueRange{1, 8});

    const Texture levels = image(Format::RG16F, {.width = 4, .height = 4, .levels = 3}, {1, 2, 3, 4, 5, 6, 7, 8}, 0, 1);
    const Source second{levels, {}, 0, 1};
    CHECK(second.size() == ivec2(2, 2));
    inspector().read(second, {0, 0}, {2, 2}, values);
    CHECK(values == std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
    CHECK(measured(second, 1, {0, 8}).extremes() == ValueRange{2, 8});
    CHECK(painted(second, {.channel = 1, .range = {0, 8}}, {}, {2, 1}) == std::vector{grey(64), grey(128)});

    const Texture depth = image(Format::Depth32F, {.width = 2, .height = 1}, {0.25f, 1});
    CHECK(measured({depth, {}}, 0, {0, 1}).extremes() == ValueRange{0.25f, 1});
    CHECK(painted({depth, {}}, {}, {}, {2, 1}) == std::vector{grey(64), grey(255)});
    const Texture kept = depth.copy("kept");
    CHECK(kept.read() == depth.read());

    const Texture samples("samples", Format::RG32F, {.width = 8, .height = 8, .samples = 4});
    const float fill[] = {0.5f, -3};
    glClearTexImage(samples.name(), 0, GL_RG, GL_FLOAT, fill);
    for (int sample = 0; sample < 4; ++sample) {
        const Source one{samples, {}, 0, 0, sample};
        CHECK(measured(one, 1, {-4, 4}).extremes() == ValueRange{-3, -3});
        inspector().read(one, {2, 3}, {2, 1}, values);
        CHECK(values == std::vector<float>{0.5f, -3, 0.5f, -3});
        CHECK(painted(one, {}, {}, {1, 1})[0] == grey(128));
    }
    CHECK(driverMessages().empty());
}
