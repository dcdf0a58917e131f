// SPDX-License-Identifier: MIT
// Pictures that the program draws without a window.
#include "app/headless.h"
#include "app/image_file.h"
#include "renderer/core/technique.h"
#include "tests/app/picture_reader.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <epoxy/gl.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

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
    CHECK(png.facts.size() == 1);
    const auto facts = nlohmann::json::parse(png.facts.at("penumbra"));
    CHECK(facts.at("program").get<std::string>().starts_with("Penumbra "));
    CHECK(facts.at("scene").at("file") == "two-boxes");
    CHECK(facts.at("scene").at("checksum").get<std::string>().starts_with("crc32 "));
    CHECK(facts.at("technique") == "pcf");
    CHECK(facts.at("parameters").at("kernel") == 9);
    CHECK(facts.at("parameters").size() == makeTechnique(findCard("pcf"))->parameters().all().size());
    CHECK(facts.at("size") == nlohmann::json{160, 90});
    CHECK(facts.at("seed") == 7);
    CHECK(facts.at("frames") == 1);
    CHECK_FALSE(facts.at("driver").get<std::string>().empty());

    captured(folder / "a.exr", {"--technique", "pcf", "--set", "kernel=9", "--seed", "7"});
    const ReadPicture exr = readExr(folder / "a.exr");
    CHECK(exr.facts.size() == facts.size());
    for (const auto& [key, fact] : facts.items()) CHECK(nlohmann::json::parse(exr.facts.at("penumbra." + key)) == fact);
    CHECK(exr.channels == std::vector<std::string>{"B", "G", "R"});

    // Looking down at a floor, what is seen comes nearer from row to row.
    captured(folder / "depth.npy", {"--buffer", "scene.depth", "--ground", "on"});
    const ReadPicture depth = readNpy(folder / "depth.npy");
    CHECK(depth.values[160 * 70] > depth.values[160 * 80]);
    CHECK(depth.values[160 * 80] > depth.values[160 * 89]);
    CHECK(depth.values[160 * 89] > 0);
}

TEST_CASE("a picture is made again from what its file tells, to the last bit") {
    const TemporaryFolder folder;
    const auto again = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "capture");
        const Result result = runProgram(arguments);
        INFO(result.errors);
        CHECK(result.exitCode == 0);
    };
    const std::vector<std::vector<std::string>> sorts = {
        {},
        {"--camera", "-0.5,1.25,4.1,0.3,-0.2,0,37.5", "--light-shape", "disk", "--light-size", "0.37", "--time",
         "0.25"},
        {"--technique", "pcf", "--set", "shape=gaussian", "--set", "sigma=0.7", "--ground", "off", "--seed", "5"},
        {"--light", "3.3,5.1,0.7,0.1,0.2,0.3", "--light-shape", "directional", "--light-size", "3", "--exposure",
         "1.1"},
        {"--show", "shadow", "--ambient", "0.1", "--frames", "5", "--play"},
        {"--buffer", "scene.depth"},
        {"--buffer", "shadow", "--preset", "pcss/64-64"},
    };
    for (const std::vector<std::string>& more : sorts) {
        INFO((more.empty() ? std::string() : more[0]));
        for (const std::string ending : {".png", ".exr"}) {
            captured(folder / ("a" + ending), more);
            again({"--like", folder / ("a" + ending), "-o", folder / ("b" + ending)});
            CHECK(readAll(folder / "a.png") == readAll(folder / "b.png"));
        }
        again({"--like", folder / "a.exr", "-o", folder / "c.png"}); // either tells enough for both
        CHECK(readAll(folder / "a.png") == readAll(folder / "c.png"));
    }
    SECTION("a scene that moves, at the moment of its last frame") {
        again(
            {"moving-caster", "-o", folder / "a.png", "--size", "160x90", "--time", "0.1", "--play", "--frames", "8"});
        again({"--like", folder / "a.png", "-o", folder / "b.png"});
        CHECK(readAll(folder / "a.png") == readAll(folder / "b.png"));
        again({"moving-caster", "-o", folder / "c.png", "--size", "160x90", "--time", "0.1"});
        CHECK(readAll(folder / "a.png") != readAll(folder / "c.png"));
    }
    SECTION("options beside it win") {
        captured(folder / "a.png", {"--technique", "pcf", "--set", "kernel=9"});
        captured(folder / "b.png", {"--technique", "pcf", "--set", "kernel=9", "--seed", "3", "--set", "slope-bias=2"});
        again({"--like", folder / "a.png", "--seed", "3", "--set", "slope-bias=2", "-o", folder / "c.png"});
        CHECK(readAll(folder / "b.png") == readAll(folder / "c.png"));
        captured(folder / "b.npy", {"--technique", "pcf", "--set", "kernel=9", "--buffer", "shadow"});
        again({"--like", folder / "a.png", "--buffer", "shadow", "-o", folder / "c.npy"});
        CHECK(readAll(folder / "b.npy") == readAll(folder / "c.npy"));
        again({"half-plane", "--like", folder / "a.png", "-o", folder / "c.png"});
        CHECK(nlohmann::json::parse(readPng(folder / "c.png").facts.at("penumbra")).at("scene").at("name") ==
              "half-plane");
    }
}

TEST_CASE("the truth and the errors can be captured") {
    const TemporaryFolder folder;
    const auto values = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--show", "shadow"});
        captured(folder / "a.png", more);
        return readPng(folder / "a.png").values;
    };
    const std::vector<float> truth = values({"--technique", "hard", "--truth", "alone"});
    CHECK((values({"--technique", "pcf", "--truth", "alone"}) == truth)); // whatever the technique
    const std::vector<float> hard = values({"--technique", "hard"});
    CHECK((hard != truth));
    // To the left of the line is the technique.
    const std::vector<float> wipe = values({"--technique", "hard", "--truth", "wipe"});
    REQUIRE(wipe.size() == hard.size());
    CHECK(std::equal(wipe.begin(), wipe.begin() + 3 * 70, hard.begin()));
    CHECK((values({"--technique", "hard", "--truth", "error"}) !=
           values({"--technique", "hard", "--truth", "error:10"})));
    requireRefused({"--truth", "errors"}, {"--truth", "'errors'"});
    requireRefused({"--truth", "error:0"}, {"--truth", "'error:0'", "1..100"});
    requireRefused({"--truth", "wipe:2"}, {"--truth", "'wipe:2'"});
}

TEST_CASE("pictures that tell nothing or nonsense are refused in one line") {
    const TemporaryFolder folder;
    const auto like = [&](const nlohmann::ordered_json& facts) {
        writePicture(folder / "a.png", {1, 1, {"grey"}, {0}}, facts);
        return folder / "a.png";
    };
    const auto refused = [&](const nlohmann::ordered_json& facts, const std::vector<std::string>& pieces) {
        std::vector<std::string> all = pieces;
        all.push_back((folder / "a.png").string() + ": ");
        const Result result = runProgram({"capture", "--like", like(facts), "-o", folder / "b.png"});
        INFO(facts.dump() << "\n" << result.errors);
        CHECK(result.exitCode == 2);
        CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
        for (const std::string& piece : all) CHECK(contains(result.errors, piece));
        CHECK_FALSE(std::filesystem::exists(folder / "b.png"));
    };
    captured(folder / "whole.png", {"--technique", "pcf"});
    const auto whole = nlohmann::ordered_json::parse(readPng(folder / "whole.png").facts.at("penumbra"));
    const auto with = [&](const char* pointer, const nlohmann::ordered_json& value) {
        auto facts = whole;
        facts[nlohmann::ordered_json::json_pointer(pointer)] = value;
        return facts;
    };
    refused(nullptr, {"tells nothing"});
    refused(with("/technique", "pcff"), {"'pcff'", "did you mean 'pcf'?"});
    refused(with("/technique", 7), {"'technique'"});
    refused(with("/parameters/kernal", 9), {"'kernal'", "did you mean 'kernel'?"});
    refused(with("/parameters/kernel", 99), {"pcf.kernel", "1..63"});
    refused(with("/camera/fov", 180), {"'camera.fov'", "1..170", "180"});
    refused(with("/camera/eye", {1, 2}), {"'camera.eye'", "3 numbers"});
    refused(with("/camera/eye", whole["camera"]["target"]), {"'camera'", "two points"});
    refused(with("/camera/fovv", 30), {"'camera.fovv'", "did you mean 'fov'?"});
    refused(with("/light/shape", "disc"), {"'light.shape'", "did you mean 'disk'?"});
    refused(with("/light/size", {0, 0}), {"'light.size'"});
    refused(with("/frames", 0), {"'frames'", "1.."});
    refused(with("/frames", 1.5), {"'frames'", "whole"});
    refused(with("/seed", -1), {"'seed'"});
    refused(with("/size", {1, 100000}), {"'size'", "16384"});
    refused(with("/ground", "on"), {"'ground'", "true or false"});
    refused(with("/colour", 1), {"unknown fact 'colour'"});
    refused(with("/scene/file", "courtyart"), {"its scene", "did you mean 'courtyard'?"});
    refused(with("/scene/file", (folder / "gone.glb").string()), {"its scene", "gone.glb", "No such file"});

    const Result other = runProgram({"capture", "--like", like(with("/scene/checksum", "crc32 00000000")), "-o",
                                     folder / "b.png", "--size", "160x90"});
    CHECK(other.exitCode == 0);
    CHECK(other.errors.starts_with("note: " + (folder / "a.png").string() + ": its scene two-boxes has changed"));
    CHECK(std::count(other.errors.begin(), other.errors.end(), '\n') == 1);
    CHECK(std::filesystem::exists(folder / "b.png"));
}

TEST_CASE("the checksum of a scene holds the files that it names") {
    const TemporaryFolder folder;
    const auto checksum = [&] {
        const Result result =
            runProgram({"capture", folder / "a.gltf", "-o", folder / "a.png", "--size", "16x16", "--json"});
        INFO(result.errors);
        REQUIRE(result.exitCode == 0);
        return nlohmann::json::parse(result.output).at("scene").at("checksum").get<std::string>();
    };
    const std::vector<float> corners = {-1, 0, -1, 1, 0, -1, 0, 0, 1};
    const auto writeCorners = [&](float height) {
        std::vector<float> values = corners;
        values[1] = height;
        writeAll(folder / "a.bin", std::string(reinterpret_cast<const char*>(values.data()), 36));
    };
    writeAll(folder / "a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -9, -1],
                       "max": [1, 9, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "a.bin"}]})");
    writeCorners(0);
    const std::string before = checksum();
    CHECK(checksum() == before);
    writeCorners(0.5f);
    CHECK(checksum() != before);
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
    std::set<std::string> seen;
    for (const nlohmann::json& technique : listing.at("techniques"))
        for (const nlohmann::json& buffer : technique.at("buffers")) {
            const std::string label = buffer.at("label");
            INFO(label);
            if (!seen.insert(label).second) continue; // such as the scene's, which all have
            std::vector<std::string> arguments{"--technique", technique.at("id"), "--buffer", label};
            const nlohmann::json& parameters = technique.at("parameters");
            if (std::any_of(parameters.begin(), parameters.end(),
                            [](const auto& p) { return p.at("id") == "map-size"; }))
                arguments.insert(arguments.end(), {"--set", "map-size=128"});
            captured(folder / "a.npy", arguments);
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
