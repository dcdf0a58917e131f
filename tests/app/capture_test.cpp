// SPDX-License-Identifier: MIT
// Pictures that the program draws without a window.
#include "app/headless.h"
#include "tests/app/picture_reader.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <epoxy/gl.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// `penumbra capture two-boxes` in a small size; fails the test unless it ends well and without complaints of OpenGL.
Result captured(const std::filesystem::path& file, std::vector<std::string> more) {
    std::vector<std::string> arguments{"capture", "two-boxes", "-o", file, "--size", "160x90"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Result result = runProgram(arguments);
    INFO(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK_FALSE(contains(result.errors, "OpenGL"));
    return result;
}

void requireRefused(std::vector<std::string> more, const std::vector<std::string>& pieces) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments{
        "capture",
        "two-boxes",
        "-o",
        folder / "a.png",
    };
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = runProgram(arguments);
    INFO(result.errors);
    CHECK(result.exitCode == 2);
    CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    for (const std::string& piece : pieces) CHECK(contains(result.errors, piece));
    CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

} // namespace

TEST_CASE("the headless context is OpenGL 4.5 core with debug messages") {
    const HeadlessContext context;
    CHECK(epoxy_gl_version() >= 45);
    CHECK_FALSE(context.rendererName().empty());
    CHECK(context.messages().empty());
    glEnable(GL_TEXTURE); // not of the core profile: an error
    CHECK(context.messages().size() == 1);
    CHECK(glGetError() == GL_INVALID_ENUM);
}

TEST_CASE("several headless contexts may follow one another") {
    for (int i = 0; i < 3; ++i) {
        const HeadlessContext context;
        GLuint texture = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &texture);
        CHECK(texture != 0);
        glDeleteTextures(1, &texture);
        CHECK(context.messages().empty());
    }
}

TEST_CASE("a driver without OpenGL 4.5 is refused in one line") {
    {
        const HeadlessContext context;
        const std::string version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
        if (!contains(version, "Mesa")) {
            WARN("left out: only Mesa can be told to offer less");
            return;
        }
    }
    const TemporaryFolder folder;
    const Result result =
        runProgram({"capture", "two-boxes", "-o", folder / "a.png"}, {"MESA_GL_VERSION_OVERRIDE=3.3"});
    INFO(result.errors);
    CHECK(result.exitCode == 2);
    CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    CHECK(contains(result.errors, "OpenGL 4.5"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("the same command gives the same bytes") {
    const TemporaryFolder folder;
    for (const std::string ending : {".png", ".exr", ".pfm", ".npy"}) {
        captured(folder / ("a" + ending), {"--technique", "pcss", "--frames", "2"});
        captured(folder / ("b" + ending), {"--technique", "pcss", "--frames", "2"});
        CHECK(readAll(folder / ("a" + ending)) == readAll(folder / ("b" + ending)));
    }
}

TEST_CASE("the formats agree on the shadow image") {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.exr", "a.pfm", "a.npy"})
        captured(folder / name, {"--technique", "pcf", "--buffer", "shadow"});
    const ReadPicture png = readPng(folder / "a.png"), exr = readExr(folder / "a.exr"), pfm = readPfm(folder / "a.pfm"),
                      npy = readNpy(folder / "a.npy");
    REQUIRE(npy.width == 160);
    REQUIRE(npy.height == 90);
    REQUIRE(npy.channels.size() == 1);
    CHECK(exr.values == npy.values);
    CHECK(pfm.values == npy.values);
    CHECK(exr.channels == std::vector<std::string>{"psi"});
    REQUIRE(png.values.size() == 3 * npy.values.size());
    for (size_t i = 0; i < npy.values.size(); ++i)
        if (std::abs(png.values[3 * i] - 255 * npy.values[i]) > 0.501f) FAIL(png.values[3 * i] << " " << npy.values[i]);
    const auto [least, most] = std::minmax_element(npy.values.begin(), npy.values.end());
    CHECK(*least == 0);
    CHECK(*most == 1);

    captured(folder / "b.npy", {"--technique", "pcf", "--buffer", "shadow.psi"});
    CHECK(readAll(folder / "b.npy") == readAll(folder / "a.npy"));
    captured(folder / "b.npy", {"--technique", "pcf", "--buffer", "pcf.shadow"});
    CHECK(readAll(folder / "b.npy") == readAll(folder / "a.npy"));
}

TEST_CASE("pictures are upright and tell how they were made") {
    const TemporaryFolder folder;
    captured(folder / "a.png", {"--technique", "pcf", "--set", "kernel=9", "--seed", "7"});
    const ReadPicture png = readPng(folder / "a.png");
    CHECK(png.width == 160);
    CHECK(png.height == 90);
    CHECK(png.channels.size() == 3);
    CHECK(png.facts.at("Software").starts_with("Penumbra "));
    CHECK(png.facts.at("scene") == "two-boxes");
    CHECK(png.facts.at("technique") == "pcf");
    CHECK(png.facts.at("parameters") == "{\"kernel\":9}");
    CHECK(png.facts.at("size") == "160x90");
    CHECK(png.facts.at("seed") == "7");
    CHECK_FALSE(png.facts.at("driver").empty());

    captured(folder / "a.exr", {"--technique", "pcf", "--set", "kernel=9", "--seed", "7"});
    const ReadPicture exr = readExr(folder / "a.exr");
    CHECK(exr.facts == png.facts);
    CHECK(exr.channels == std::vector<std::string>{"B", "G", "R"});

    // Looking down at a floor, what is seen comes nearer from row to row.
    captured(folder / "depth.npy", {"--buffer", "scene.depth", "--ground", "on"});
    const ReadPicture depth = readNpy(folder / "depth.npy");
    CHECK(depth.values[160 * 70] > depth.values[160 * 80]);
    CHECK(depth.values[160 * 80] > depth.values[160 * 89]);
    CHECK(depth.values[160 * 89] > 0);
}

TEST_CASE("what was told is told again: the camera of a picture's facts gives the same picture") {
    const TemporaryFolder folder;
    captured(folder / "a.png",
             {"--camera", "-0.5,1.25,4.1,0.3,-0.2,0,37.5", "--light-shape", "disk", "--time", "0.25"});
    const auto facts = readPng(folder / "a.png").facts;
    captured(folder / "b.png",
             {"--camera", facts.at("camera"), "--light", facts.at("light"), "--light-shape", facts.at("light-shape"),
              "--light-size", facts.at("light-size"), "--time", facts.at("time"), "--ground", facts.at("ground")});
    CHECK(readAll(folder / "a.png") == readAll(folder / "b.png"));
}

TEST_CASE("the options reach the picture") {
    const TemporaryFolder folder;
    captured(folder / "a.png", {"--technique", "pcf"});
    const std::string plain = readAll(folder / "a.png");
    const std::vector<std::vector<std::string>> changes = {{"--show", "shadow"},       {"--exposure", "1"},
                                                           {"--ambient", "0.5"},       {"--light-shape", "directional"},
                                                           {"--light-size", "0.5,2"},  {"--camera", "3,2,3,0,0,0"},
                                                           {"--light", "2,4,1,0,0,0"}, {"--set", "pcf.kernel=31"}};
    for (const std::vector<std::string>& change : changes) {
        std::vector<std::string> more{"--technique", "pcf"};
        more.insert(more.end(), change.begin(), change.end());
        captured(folder / "b.png", more);
        INFO(change[0]);
        CHECK(readAll(folder / "b.png") != plain);
    }
}

TEST_CASE("a preset gives the picture of its parameters, and --set wins over it") {
    const TemporaryFolder folder;
    captured(folder / "a.npy", {"--buffer", "shadow", "--preset", "pcf/gaussian-9x9"});
    captured(folder / "b.npy", {"--buffer", "shadow", "--technique", "pcf", "--set", "kernel=9", "--set",
                                "shape=gaussian", "--set", "sigma=2.4"});
    CHECK(readAll(folder / "a.npy") == readAll(folder / "b.npy"));
    captured(folder / "a.npy", {"--buffer", "shadow", "--preset", "pcf/gaussian-9x9", "--set", "kernel=3"});
    CHECK(readAll(folder / "a.npy") != readAll(folder / "b.npy"));
}

TEST_CASE("a playing scene ends at the time of its last frame") {
    const TemporaryFolder folder;
    const auto capture = [&](const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> arguments{"capture", "moving-caster", "-o",   folder / name, "--size",
                                           "160x90",  "--technique",   "hard", "--buffer",    "shadow"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result result = runProgram(arguments);
        INFO(result.errors);
        REQUIRE(result.exitCode == 0);
        return readAll(folder / name);
    };
    const std::string played = capture("a.npy", {"--play", "--frames", "31"});
    CHECK(played == capture("b.npy", {"--time", "0.5"}));
    CHECK(played != capture("c.npy", {"--frames", "31"}));
}

TEST_CASE("the result is told as JSON") {
    const TemporaryFolder folder;
    const Result result = captured(folder / "a.png", {"--json", "--technique", "hard"});
    const nlohmann::json json = nlohmann::json::parse(result.output);
    CHECK(json.at("file") == (folder / "a.png").string());
    CHECK(json.at("width") == 160);
    CHECK(json.at("height") == 90);
    CHECK(json.at("technique") == "hard");
    CHECK_FALSE(json.at("driver").get<std::string>().empty());
}

TEST_CASE("every buffer of every technique can be written raw and finite") {
    const TemporaryFolder folder;
    const nlohmann::json listing = nlohmann::json::parse(runProgram({"list", "--json", "two-boxes"}).output);
    for (const nlohmann::json& technique : listing.at("techniques"))
        for (const nlohmann::json& buffer : technique.at("buffers")) {
            const std::string label = buffer.at("label");
            INFO(label);
            captured(folder / "a.npy", {"--technique", technique.at("id"), "--buffer", label});
            const ReadPicture picture = readNpy(folder / "a.npy");
            CHECK(picture.channels.size() == buffer.at("channels").size());
            CHECK(std::all_of(picture.values.begin(), picture.values.end(), [](float v) { return std::isfinite(v); }));
        }
}

TEST_CASE("buffers that are not there are refused with those that are") {
    requireRefused({"--technique", "pcf", "--buffer", "shadw"}, {"'shadw'", "did you mean 'shadow'?", "scene.depth"});
    requireRefused({"--technique", "pcf", "--buffer", "scene.depht"}, {"did you mean 'scene.depth'?"});
    requireRefused({"--technique", "pcf", "--buffer", "shadow.phi"}, {"no channel 'phi'", "'psi'"});
    requireRefused({"--technique", "pcf", "--buffer", "scene.normal"}, {".png", "geometric-x"});
    requireRefused({"--technique", "pcf", "--buffer", "shadow", "--layer", "1"}, {"--layer", "0..0"});
    requireRefused({"--technique", "pcf", "--buffer", "shadow", "--level", "2"}, {"--level", "0..0"});
}

TEST_CASE("a frame that needs more memory than allowed is refused with the images named") {
    requireRefused({"--texture-limit", "1", "--size", "4096x4096"}, {"the limit is 1 MiB", "scene.normal"});
}
