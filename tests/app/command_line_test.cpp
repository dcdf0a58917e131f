// SPDX-License-Identifier: MIT
// What the program says and how it ends, without drawing anything.
#include "renderer/core/paths.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// Exit code 2, nothing on stdout, one line on stderr that says all of `pieces`.
void requireRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& pieces,
                    const std::vector<std::string>& environment = {}) {
    const Result result = runProgram(arguments, environment);
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("penumbra" << command << "\n" << result.errors);
    CHECK(result.exitCode == 2);
    CHECK(result.output.empty());
    CHECK(result.errors.starts_with("penumbra: "));
    CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    for (const std::string& piece : pieces) {
        INFO("expected: " << piece);
        CHECK(contains(result.errors, piece));
    }
}

} // namespace

TEST_CASE("help and version go to stdout") {
    const Result help = runProgram({"--help"});
    CHECK(help.exitCode == 0);
    CHECK(help.errors.empty());
    for (const char* word : {"capture", "list", "--technique", "--set", "--camera", "--light-size"})
        CHECK(contains(help.output, word));
    const Result captureHelp = runProgram({"capture", "--help"});
    CHECK(captureHelp.exitCode == 0);
    CHECK(contains(captureHelp.output, "--buffer"));
    const Result version = runProgram({"--version"});
    CHECK(version.exitCode == 0);
    CHECK(version.output == "penumbra " PENUMBRA_VERSION "\n");
}

TEST_CASE("unknown words are refused with the nearest known one") {
    requireRefused({"list", "--tecnique", "pcf"}, {"'--tecnique'", "did you mean '--technique'?"});
    requireRefused({"capture", "-o", "a.png", "--bufer=shadow"}, {"'--bufer'", "did you mean '--buffer'?"});
    requireRefused({"list", "a", "b"}, {"'b'"});
    requireRefused({"list", "--technique", "pcg"}, {"'pcg'", "did you mean 'pcf'?"});
    requireRefused({"list", "--set", "pcf.kernal=9"}, {"'kernal'", "did you mean 'kernel'?"});
    requireRefused({"list", "--set", "psf.kernel=9"}, {"'psf'", "did you mean 'pcf'?"});
    requireRefused({"list", "--set", "kernel"}, {"'kernel' is not NAME=VALUE"});
    requireRefused({"list", "--light-shape", "disc"}, {"--light-shape", "rectangle, disk, directional", "'disk'"});
    requireRefused({"list", "--show", "light"}, {"--show", "lit, shadow"});
    requireRefused({"list", "--preset", "pcf/gaussian-9x8"}, {"did you mean 'pcf/gaussian-9x9'?"});
    requireRefused({"list", "courtyart"}, {"'courtyart'", "did you mean 'courtyard'?"});
}

TEST_CASE("values out of range are refused with the range") {
    requireRefused({"list", "--set", "pcf.kernel=99"}, {"pcf.kernel", "99", "1..63 texels, odd"});
    requireRefused({"list", "--set", "pcf.kernel=8"}, {"pcf.kernel", "1..63 texels, odd"});
    requireRefused({"list", "--set", "pcf.sigma=nan"}, {"pcf.sigma"});
    requireRefused({"list", "--set", "pcf.sigma=inf"}, {"pcf.sigma"});
    for (const char* size : {"0x0", "100000x100000", "640", "640x", "640x480x3", "-1x5", "axb", "640 x 480", "1e3x10"})
        requireRefused({"list", "--size", size}, {"--size", size, "1..16384"});
    requireRefused({"list", "--frames", "0"}, {"--frames", "1..1000000"});
    requireRefused({"list", "--seed", "-1"}, {"--seed", "0..4294967295"});
    for (const char* time : {"nan", "inf", "-1", "1e300", "", "1s"})
        requireRefused({"list", "--time", time}, {"--time", "0..1e+07"});
    for (const char* camera :
         {"1,2,3", "nan,0,0,1,1,1", "0,0,0,0,0,inf", "1,1,1,1,1,1", "1e9,0,0,1,1,1", "1,2,3,4,5,6,7,8"})
        requireRefused({"list", "--camera", camera}, {"--camera", "X,Y,Z,TX,TY,TZ"});
    requireRefused({"list", "--camera", "0,0,1,0,0,0,180"}, {"--camera", "1..170"});
    requireRefused({"list", "--light", "0,1,0,0,0,0,45"}, {"--light", "X,Y,Z,TX,TY,TZ"});
    requireRefused({"list", "--light-size", "0"}, {"--light-size"});
    requireRefused({"list", "--light-shape", "disk", "--light-size", "1,2"}, {"--light-size", "one diameter"});
    requireRefused({"list", "--light-shape", "directional", "--light-size", "400"}, {"--light-size", "degrees"});
    requireRefused({"list", "--ground", "maybe"}, {"--ground", "off, on"});
    requireRefused({"list", "--exposure", "nan"}, {"--exposure"});
    requireRefused({"list", "--ambient", "-0.5"}, {"--ambient"});
    requireRefused({"list", "--texture-limit", "0"}, {"--texture-limit"});
}

TEST_CASE("options without a value, twice or missing are refused") {
    requireRefused({"list", "--technique"}, {"--technique"});
    requireRefused({"list", "--technique", "pcf", "--technique", "pcss"}, {"--technique"});
    requireRefused({"capture"}, {"-o FILE"});
}

TEST_CASE("scenes that cannot be read are refused by name") {
    const TemporaryFolder folder;
    const auto refuse = [&](const std::string& name, const std::string& reason) {
        const std::string file = folder / name;
        requireRefused({"capture", file, "-o", folder / "a.png"}, {file, reason});
        CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
    };
    refuse("missing.glb", "No such file");
    std::filesystem::create_directory(folder / "folder.glb");
    refuse("folder.glb", "directory");
    writeAll(folder / "empty.glb", "");
    refuse("empty.glb", "");
    writeAll(folder / "empty.gltf", "");
    refuse("empty.gltf", "");
    const std::string whole = readAll(assetFolder() / "scenes" / "two-boxes.glb");
    for (const size_t size : {size_t{3}, size_t{12}, size_t{40}, whole.size() / 2, whole.size() - 1}) {
        writeAll(folder / "truncated.glb", whole.substr(0, size));
        refuse("truncated.glb", "");
    }
}

TEST_CASE("places that cannot be written are refused before anything is drawn") {
    const TemporaryFolder folder;
    writeAll(folder / "file", "x");
    requireRefused({"capture", "-o", folder / "missing/a.png"}, {"missing/a.png", "No such file or directory"});
    requireRefused({"capture", "-o", folder / "file/a.png"}, {"file/a.png", "Not a directory"});
    std::filesystem::create_directory(folder / "folder.png");
    requireRefused({"capture", "-o", folder / "folder.png"}, {"folder.png", "not a regular file"});
    requireRefused({"capture", "-o", folder / "a.jpeg"}, {"a.jpeg", ".png, .exr, .pfm or .npy"});
}

TEST_CASE("presets that are damaged are refused by file and key") {
    const TemporaryFolder folder;
    const auto refuse = [&](const std::string& text, const std::vector<std::string>& pieces) {
        const std::string file = folder / "preset.json";
        writeAll(file, text);
        std::vector<std::string> all = pieces;
        all.push_back(file + ": ");
        requireRefused({"list", "--preset", file}, all);
    };
    refuse("", {"line 1"});
    refuse("{\n\"technique\": \"pcf\",\n", {"line 3"});
    refuse("[]", {"array"});
    refuse("{}", {"technique"});
    refuse(R"({"technique": "pcf", "parameter": {}})", {"'parameter'", "did you mean 'parameters'?"});
    refuse(R"({"technique": "pcff"})", {"'pcff'", "did you mean 'pcf'?"});
    refuse(R"({"technique": 7})", {"technique"});
    refuse(R"({"technique": "pcf", "parameters": {"kernal": 9}})", {"'kernal'", "did you mean 'kernel'?"});
    refuse(R"({"technique": "pcf", "parameters": {"kernel": 99}})", {"pcf.kernel", "1..63"});
    refuse(R"({"technique": "pcf", "parameters": {"kernel": "9"}})", {"pcf.kernel", "whole number", "string"});
    refuse(R"({"technique": "pcf", "parameters": {"kernel": null}})", {"pcf.kernel", "null"});
    refuse(R"({"technique": "pcf", "parameters": {"sigma": 1e999}})", {"1e999"});
    refuse(R"({"technique": "pcf", "parameters": {"shape": "round"}})", {"pcf.shape", "box, gaussian, poisson"});
    refuse(std::string(2 << 20, '['), {"bytes"});
    const std::string deep = std::string(250'000, '[') + std::string(250'000, ']');
    refuse(R"({"technique": )" + deep + "}", {"'technique'"});
    refuse(R"({"technique": "pcf", "parameters": )" + deep + "}", {"'parameters'", "array"});
    refuse(R"({"technique": "pcf", "parameters": {"kernel": )" + deep + "}}", {"pcf.kernel", "array"});
    requireRefused({"list", "--preset", folder.path()}, {folder.path().string(), "directory"});
}

TEST_CASE("without a display the window is refused in words") {
    requireRefused({}, {"display", "penumbra capture"}, {"DISPLAY", "WAYLAND_DISPLAY"});
}

TEST_CASE("the listing names everything that it should") {
    const Result result = runProgram({"list", "--json"});
    REQUIRE(result.exitCode == 0);
    CHECK(result.errors.empty());
    const nlohmann::json listing = nlohmann::json::parse(result.output);
    std::set<std::string> ids;
    for (const nlohmann::json& technique : listing.at("techniques")) {
        INFO(technique.dump());
        ids.insert(technique.at("id").get<std::string>());
        for (const char* key : {"title", "idea", "assumes", "fails"})
            CHECK_FALSE(technique.at(key).get<std::string>().empty());
        for (const char* key : {"authors", "venue"}) CHECK(technique.at(key).is_string());
        CHECK(technique.at("year").is_number_integer());
        for (const nlohmann::json& parameter : technique.at("parameters")) {
            for (const char* key : {"id", "label", "help", "type", "range"})
                CHECK_FALSE(parameter.at(key).get<std::string>().empty());
            for (const char* key : {"symbol", "unit", "source", "group"}) CHECK(parameter.at(key).is_string());
            if (parameter.at("type") == "real" || parameter.at("type") == "integer") {
                CHECK(parameter.at("min") <= parameter.at("default"));
                CHECK(parameter.at("default") <= parameter.at("max"));
                CHECK((parameter.at("scale") == "linear" || parameter.at("scale") == "logarithmic"));
            }
            if (parameter.at("type") == "choice") {
                const auto& choices = parameter.at("choices");
                CHECK(std::find(choices.begin(), choices.end(), parameter.at("default")) != choices.end());
            }
        }
        bool shadow = false;
        for (const nlohmann::json& buffer : technique.at("buffers")) {
            shadow |= buffer.at("label") == technique.at("id").get<std::string>() + ".shadow";
            CHECK_FALSE(buffer.at("format").get<std::string>().empty());
            CHECK_FALSE(buffer.at("channels").empty());
            for (const nlohmann::json& channel : buffer.at("channels"))
                for (const char* key : {"name", "meaning"}) CHECK_FALSE(channel.at(key).get<std::string>().empty());
        }
        CHECK(shadow);
    }
    for (const char* id : {"none", "hard", "pcf", "pcss", "light-sampling"}) CHECK(ids.count(id) == 1);
    CHECK(listing.at("scenes").at(0).at("name") == "courtyard");
    CHECK_FALSE(listing.at("scenes").at(0).at("description").get<std::string>().empty());
    const auto& presets = listing.at("presets");
    for (const char* preset : {"pcf/gaussian-9x9", "pcss/16-16", "pcss/32-32", "pcss/64-64"})
        CHECK(std::find(presets.begin(), presets.end(), preset) != presets.end());

    const Result text = runProgram({"list", "--technique", "pcf"});
    CHECK(text.exitCode == 0);
    CHECK(contains(text.output, "pcf.kernel"));
    CHECK_FALSE(contains(text.output, "pcss."));
}

TEST_CASE("results that cannot be printed end with code 1") {
    const std::string command = std::string("'" PENUMBRA_PROGRAM "' list > /dev/full 2> /dev/null");
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 1);
}
