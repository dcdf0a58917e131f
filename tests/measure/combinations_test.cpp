// SPDX-License-Identifier: MIT
#include "renderer/measure/camera_path.h"
#include "renderer/measure/combinations.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <glm/glm.hpp>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::vector<Setting> settingsOf(const std::vector<std::string>& ids) {
    std::vector<Setting> settings;
    for (const std::string& id : ids) settings.emplace_back(findCard(id));
    return settings;
}

std::vector<std::string> textsOf(const std::vector<Setting>& settings) {
    std::vector<std::string> texts;
    for (const Setting& setting : settings) {
        texts.push_back(std::string(setting.card->id));
        if (const std::string text = setting.text(); !text.empty()) texts.back() += " " + text;
    }
    return texts;
}

std::vector<std::string> swept(const std::vector<std::string>& ids, const std::vector<std::string>& sweeps) {
    std::vector<SweepAxis> axes;
    for (const std::string& sweep : sweeps) axes.push_back(parseSweep(sweep));
    return textsOf(combine(settingsOf(ids), axes));
}

using Texts = std::vector<std::string>;

} // namespace

TEST_CASE("lists and steps are swept, several as a cross product whose last axis turns fastest") {
    CHECK(swept({"pcf"}, {}) == Texts{"pcf"});
    CHECK(swept({"pcf"}, {"kernel=3,5"}) == Texts{"pcf kernel 3", "pcf kernel 5"});
    CHECK(swept({"pcf"}, {"pcf.kernel=3,5", "shape=box,gaussian"}) ==
          Texts{"pcf shape box, kernel 3", "pcf shape gaussian, kernel 3", "pcf shape box, kernel 5",
                "pcf shape gaussian, kernel 5"});
    CHECK(swept({"pcss"}, {"filter-taps=4:64:4"}) ==
          Texts{"pcss filter-taps 4", "pcss filter-taps 24", "pcss filter-taps 44", "pcss filter-taps 64"});
    CHECK(swept({"pcss"}, {"filter-taps=1:64:4:log"}) ==
          Texts{"pcss filter-taps 1", "pcss filter-taps 4", "pcss filter-taps 16", "pcss filter-taps 64"});
    CHECK(swept({"pcss"}, {"filter-taps=8:8:1"}) == Texts{"pcss filter-taps 8"});
}

TEST_CASE("steps that a parameter cannot take go to the nearest that it can, once") {
    CHECK(swept({"pcf"}, {"kernel=1:5:5"}).size() == 3); // 1, 3, 5
}

TEST_CASE("an axis is for the techniques that have it") {
    CHECK(swept({"none", "pcf", "pcss"}, {"filter-taps=4,8"}) ==
          Texts{"none", "pcf", "pcss filter-taps 4", "pcss filter-taps 8"});
    const std::vector<Setting> settings = combine(settingsOf({"none", "pcss"}), {parseSweep("filter-taps=4,8")});
    for (size_t i = 0; i < settings.size(); ++i) CHECK(settings[i].place == i);
}

TEST_CASE("what is set is told, even if it is the default") {
    std::vector<Setting> settings = settingsOf({"pcf", "pcss"});
    const std::string kernel = settings[0].parameters().at("kernel").text();
    assign(settings, "pcf.kernel=" + kernel);
    CHECK(textsOf(settings) == Texts{"pcf kernel " + kernel, "pcss"});
    assign(settings, "map-size=512");
    CHECK(contains(settings[0].text(), "map-size 512"));
    CHECK(contains(settings[1].text(), "map-size 512"));
}

TEST_CASE("wrong sweeps and assignments are refused in one line") {
    const auto refused = [](const std::vector<std::string>& ids, const std::string& sweep) {
        return refusal([&] { combine(settingsOf(ids), {parseSweep(sweep)}); });
    };
    for (const char* sweep : {"kernel", "=3", "kernel=", "kernel=1:2", "kernel=1:2:3:lin", "kernel=1:2:3:log:4"})
        CHECK(contains(refused({"pcf"}, sweep), "NAME=FROM:TO:STEPS"));
    for (const char* sweep : {"kernel=1:5:0", "kernel=1:5:2.5", "kernel=1:5:1000000"})
        CHECK(contains(refused({"pcf"}, sweep), "STEPS"));
    for (const char* sweep : {"kernel=a:5:2", "kernel=1:nan:2", "kernel=1:inf:2"})
        CHECK(contains(refused({"pcf"}, sweep), "is not a number"));
    CHECK(contains(refused({"pcf"}, "kernel=0:5:3:log"), "above 0"));
    CHECK(contains(refused({"pcf"}, "kernel=1:99:3"), "1..63 texels, odd"));
    CHECK(contains(refused({"pcf"}, "kernel=3,99"), "1..63 texels, odd"));
    CHECK(contains(refused({"pcf", "pcss"}, "kernal=3,5"), "did you mean 'kernel'?"));
    CHECK(contains(refused({"pcf"}, "pcf.kernal=3,5"), "did you mean 'kernel'?"));
    CHECK(contains(refused({"pcf"}, "pcff.kernel=3,5"), "did you mean 'pcf'?"));
    CHECK(contains(refused({"pcss"}, "pcf.kernel=3,5"), "no technique that is measured"));
    CHECK(contains(refused({"pcss"}, "light-scale=0.5:1:10000"), ""));
    std::vector<Setting> settings = settingsOf({"pcf"});
    CHECK(contains(refusal([&] { assign(settings, "kernel"); }), "NAME=VALUE"));
    CHECK(contains(refusal([&] { assign(settings, "filter-taps=4"); }), "no parameter 'filter-taps'"));
    CHECK(contains(refusal([&] {
                       combine(settingsOf({"pcss"}),
                               {parseSweep("filter-taps=1:64:64"), parseSweep("search-taps=1:64:64"),
                                parseSweep("map-size=64:8192:64")});
                   }),
                   "more than 100000"));
}

TEST_CASE("an orbit keeps its distance and comes home") {
    Camera start;
    start.eye = {3, 2, 4};
    start.target = {1, 1, 0};
    const CameraPath orbit = CameraPath::orbit(start);
    CHECK(orbit.frames() == 361);
    const float distance = glm::distance(start.eye, start.target);
    for (int frame = 0; frame < orbit.frames(); frame += 7) {
        CHECK(glm::distance(orbit.at(frame).eye, start.target) == Approx(distance).epsilon(1e-5));
        CHECK(orbit.at(frame).eye.y == Approx(start.eye.y));
    }
    CHECK(orbit.at(0).eye == start.eye);
    CHECK(glm::distance(orbit.at(360).eye, start.eye) < 1e-4f);
    CHECK(glm::distance(orbit.at(180).eye, glm::vec3(-1, 2, -4)) < 1e-4f);
}

TEST_CASE("a walk stays on the level and ends half way") {
    Camera start;
    start.eye = {0, 2, 8};
    start.target = {0, 0, 0};
    const CameraPath walk = CameraPath::walk(start);
    CHECK(walk.at(0).eye == start.eye);
    const Camera end = walk.at(walk.frames() - 1);
    CHECK(glm::distance(end.eye, glm::vec3(0, 2, 4)) < 1e-4f);
    CHECK(walk.frames() == 241);
}

TEST_CASE("a recorded path goes straight from line to line, a frame each sixtieth of a second") {
    const CameraPath path = CameraPath::parse("# a comment\n0, 0,1,5, 0,0,0\n\n0.5,3,1,5,0,0,0,60\r\n", Camera());
    CHECK(path.frames() == 31);
    CHECK(path.at(0).eye == glm::vec3(0, 1, 5));
    CHECK(glm::distance(path.at(15).eye, glm::vec3(1.5f, 1, 5)) < 1e-5f);
    CHECK(path.at(30).fovY == Approx(60));
    CHECK(path.at(100).eye == glm::vec3(3, 1, 5));
}

TEST_CASE("damaged paths are refused by line") {
    const auto refused = [](const std::string& text) { return refusal([&] { CameraPath::parse(text, Camera()); }); };
    CHECK(contains(refused(""), "T,X,Y,Z,TX,TY,TZ"));
    CHECK(contains(refused("# nothing\n"), "T,X,Y,Z,TX,TY,TZ"));
    CHECK(contains(refused("0,0,1,5,0,0,0\n1,a,1,5,0,0,0"), "line 2"));
    CHECK(contains(refused("0,0,1,5,0,0"), "line 1"));
    CHECK(contains(refused("0,0,1,5,0,0,0,60,1"), "line 1"));
    CHECK(contains(refused("1,0,1,5,0,0,0"), "start at 0 s"));
    CHECK(contains(refused("0,0,1,5,0,0,0\n0,1,1,5,0,0,0"), "later time"));
    CHECK(contains(refused("0,0,1,5,0,1,5"), "two points"));
    CHECK(contains(refused("0,0,1,5,0,0,0,200"), "1..170"));
    CHECK(contains(refused("0,1e9,1,5,0,0,0"), "1e+06 m"));
    CHECK(contains(refused("0,nan,1,5,0,0,0"), "line 1"));
    CHECK(contains(refused("0,0,1,5,0,0,0\n99999,1,1,5,0,0,0"), "an hour"));
}
