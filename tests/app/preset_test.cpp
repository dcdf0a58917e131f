// SPDX-License-Identifier: MIT
#include "app/preset.h"

#include "tests/app/program.h"
#include "tests/catch.h"

#include <cmath>
#include <cstdlib>
#include <random>

using namespace penumbra;
using namespace penumbra::test;

namespace {

// A value that set() accepts and that is not the default.
double otherValue(const Parameter& parameter) {
    const Spec& spec = parameter.spec();
    const double byDefault = parameter.defaultValue();
    if (parameter.type() != Parameter::Type::Real || spec.step > 0)
        return byDefault == spec.max ? spec.min : parameter.nearest(byDefault + spec.step);
    const double inside = spec.min + (spec.max - spec.min) / 3; // has no short decimal text
    return inside == byDefault ? spec.max : inside;
}

} // namespace

TEST_CASE("every parameter of every technique comes back from a preset") {
    const TemporaryFolder folder;
    for (const Card* card : catalogue()) {
        TechniqueShelf written;
        written.choose(card->id);
        for (Parameter* parameter : written.parameters().all()) parameter->set(otherValue(*parameter));
        const auto file = folder / (std::string(card->id) + ".json");
        savePreset(file, written);

        TechniqueShelf read;
        loadPreset(file, read);
        CHECK(read.card().id == card->id);
        for (const Parameter* parameter : written.parameters().all()) {
            INFO(parameter->qualifiedName());
            CHECK(parameter->changed());
            CHECK(read.parameters().at(parameter->spec().id).value() == parameter->value());
        }
    }
}

TEST_CASE("a preset holds what differs from the defaults and resets the rest") {
    const TemporaryFolder folder;
    TechniqueShelf shelf;
    shelf.choose("pcf");
    CHECK(presetOf(shelf).dump() == R"({"technique":"pcf","parameters":{}})");
    savePreset(folder / "defaults.json", shelf);
    shelf.assign("kernel=9");
    CHECK(presetOf(shelf).dump() == R"({"technique":"pcf","parameters":{"kernel":9}})");
    loadPreset(folder / "defaults.json", shelf);
    CHECK_FALSE(shelf.parameters().at("kernel").changed());
}

TEST_CASE("any values come back from a preset, and a file holds no default") {
    const TemporaryFolder folder;
    std::mt19937 random(7);
    const auto share = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    for (int round = 0; round < 20; ++round)
        for (const Card* card : catalogue()) {
            TechniqueShelf written, read;
            written.choose(card->id);
            read.choose(card->id);
            for (Parameter* p : read.parameters().all()) p->set(otherValue(*p));
            for (Parameter* p : written.parameters().all())
                if (share() < 0.5) p->set(p->nearest(p->spec().min + share() * (p->spec().max - p->spec().min)));
            savePreset(folder / "a.json", written);
            loadPreset(folder / "a.json", read);
            CHECK(read.parameters() == written.parameters());
            const auto json = nlohmann::json::parse(readAll(folder / "a.json"));
            for (const auto& [id, value] : json["parameters"].items()) {
                INFO(id);
                CHECK(written.parameters().at(id).changed());
            }
        }
}

TEST_CASE("a preset that is refused changes nothing") {
    const TemporaryFolder folder;
    TechniqueShelf shelf;
    shelf.choose("hard");
    shelf.assign("pcf.kernel=9");
    for (const char* text : {R"({"technique": "pcf", "parameters": {"sigma": 1.5, "kernel": 8}})",
                             R"({"technique": "pcf", "parameters": {"kernel": 11, "extra": 1}})", "{"}) {
        writeAll(folder / "a.json", text);
        CHECK(refusal([&] { loadPreset(folder / "a.json", shelf); }).starts_with((folder / "a.json").string() + ": "));
        CHECK(shelf.card().id == "hard");
        CHECK(shelf.parametersOf("pcf").at("kernel").value() == 9);
        CHECK_FALSE(shelf.parametersOf("pcf").at("sigma").changed());
    }
}

TEST_CASE("every built-in preset loads, is filed under its technique and names every value that differs") {
    const TemporaryFolder folder;
    ::setenv("PENUMBRA_CONFIG_DIR", folder.path().c_str(), 1); // no presets of the user's own
    const std::vector<std::string> names = presetNames();
    CHECK(names.size() >= 4);
    for (const std::string& name : names) {
        INFO(name);
        TechniqueShelf shelf;
        loadPreset(findPreset(name), shelf);
        CHECK(name.substr(0, name.find('/')) == shelf.card().id);
        const auto written = nlohmann::json::parse(readAll(findPreset(name)));
        const auto differing = presetOf(shelf);
        for (const auto& [id, value] : differing["parameters"].items()) CHECK(written["parameters"].at(id) == value);
    }
    ::unsetenv("PENUMBRA_CONFIG_DIR");
}

TEST_CASE("a user's preset is found by its name, before a built-in one") {
    const TemporaryFolder folder;
    ::setenv("PENUMBRA_CONFIG_DIR", folder.path().c_str(), 1);
    TechniqueShelf shelf;
    shelf.choose("pcf");
    shelf.assign("kernel=21");
    savePreset(userPresetFile("pcf", "gaussian-9x9"), shelf);
    savePreset(userPresetFile("pcf", "my own"), shelf);
    TechniqueShelf read;
    for (const char* name : {"pcf/gaussian-9x9", "pcf/my own"}) {
        loadPreset(findPreset(name), read);
        CHECK(read.parameters().at("kernel").value() == 21);
    }
    for (const char* name : {"", "..", "../x", "a/b", ".hidden", " x", "a\nb"})
        CHECK_FALSE(refusal([&] { userPresetFile("pcf", name); }).empty());
    ::unsetenv("PENUMBRA_CONFIG_DIR");
}

TEST_CASE("a user's presets are renamed and deleted, and nobody's else") {
    const TemporaryFolder folder;
    ::setenv("PENUMBRA_CONFIG_DIR", folder.path().c_str(), 1);
    TechniqueShelf shelf;
    shelf.choose("pcf");
    shelf.assign("kernel=21");
    for (const char* name : {"one", "two"}) savePreset(userPresetFile("pcf", name), shelf);
    const std::string bytes = readAll(userPresetFile("pcf", "one"));
    const auto names = [] { return ownPresetNames(); };

    CHECK(contains(refusal([] { renamePreset("pcf", "one", "two"); }), "already"));
    CHECK(contains(refusal([] { renamePreset("pcf", "three", "four"); }), "'three'"));
    CHECK_FALSE(refusal([] { renamePreset("pcf", "one", "../one"); }).empty());
    CHECK(contains(refusal([] { renamePreset("pcf", "gaussian-9x9", "mine"); }), "'gaussian-9x9'"));
    CHECK(contains(refusal([] { deletePreset("pcf", "gaussian-9x9"); }), "'gaussian-9x9'"));
    CHECK(names() == std::vector<std::string>{"pcf/one", "pcf/two"});

    renamePreset("pcf", "one", "first of all");
    CHECK(names() == std::vector<std::string>{"pcf/first of all", "pcf/two"});
    CHECK(readAll(userPresetFile("pcf", "first of all")) == bytes);
    deletePreset("pcf", "two");
    CHECK(names() == std::vector<std::string>{"pcf/first of all"});
    CHECK(builtInPresetNames().size() >= 4);
    ::unsetenv("PENUMBRA_CONFIG_DIR");
}

TEST_CASE("the presets of the papers have the values of the papers, whatever the defaults") {
    const TemporaryFolder folder;
    ::setenv("PENUMBRA_CONFIG_DIR", folder.path().c_str(), 1);
    const auto value = [](const char* preset, const char* parameter) {
        TechniqueShelf shelf;
        loadPreset(findPreset(preset), shelf);
        return shelf.parameters().at(parameter).text();
    };
    for (const char* taps : {"16", "32", "64"}) {
        const std::string name = std::string("pcss/") + taps + "-" + taps;
        CHECK(value(name.c_str(), "search-taps") == taps);
        CHECK(value(name.c_str(), "filter-taps") == taps);
    }
    CHECK(value("pcf/gaussian-9x9", "shape") == "gaussian");
    CHECK(value("pcf/gaussian-9x9", "kernel") == "9");
    CHECK(value("pcf/gaussian-9x9", "sigma") == "2.4");
    for (const auto& [parameter, paper, thesis] : {std::tuple("format", "16f", "32f"),
                                                   {"depth-test", "absolute", "relative"},
                                                   {"moving", "disocclusion", "decrement"},
                                                   {"mixing", "threshold", "blend"},
                                                   {"error", "equation-3", "equation-3"},
                                                   {"central-map", "false", "false"},
                                                   {"guided", "0", "0"},
                                                   {"taps", "16", "16"}}) {
        CAPTURE(parameter);
        CHECK(value("temporal/paper", parameter) == paper);
        CHECK(value("temporal/thesis", parameter) == thesis);
    }
    ::unsetenv("PENUMBRA_CONFIG_DIR");
}
