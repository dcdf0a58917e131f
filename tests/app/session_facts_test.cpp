// SPDX-License-Identifier: MIT
#include "app/session_facts.h"

#include "app/image_file.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <random>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::shared_ptr<const Scene> emptyScene() {
    auto scene = std::make_shared<Scene>();
    scene->name = "empty";
    scene->materials.emplace_back();
    return scene;
}

// Sessions that differ from one another in every fact.
class Dice {
public:
    double within(Range range) { return std::uniform_real_distribution<double>(range.min, range.max)(random_); }
    int whole(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
    bool coin() { return whole(0, 1) == 1; }

    Session session(std::shared_ptr<const Scene> scene) {
        const auto point = [&] {
            const Range range{-100, 100};
            return glm::vec3(within(range), within(range), within(range));
        };
        Session s;
        s.setScene(std::move(scene));
        const auto cards = catalogue();
        for (TechniqueShelf* shelf : {&s.techniques, &s.rival}) {
            shelf->choose(cards[static_cast<size_t>(whole(0, static_cast<int>(cards.size()) - 1))]->id);
            for (Parameter* p : shelf->parameters().all())
                if (coin()) p->set(p->nearest(within({p->spec().min, p->spec().max})));
        }
        s.comparison = {static_cast<Against>(whole(0, 2)), static_cast<CompareAs>(whole(0, 3)),
                        static_cast<float>(within({0, 1})), coin(), static_cast<float>(within({1, 100}))};
        s.camera = {point(), point(), point(), static_cast<float>(within(limits::fovY))};
        const auto light = [&] {
            return AreaLight{
                static_cast<LightShape>(whole(0, 2)),       point(),           point(),
                {within({0.01, 100}), within({0.01, 100})}, glm::abs(point()), static_cast<float>(within({0, 10}))};
        };
        s.light = light();
        for (int i = whole(0, mostFurtherLights); i > 0; --i) s.furtherLights.push_back({light(), coin()});
        s.ground = coin();
        s.display = {coin() ? Show::Lit : Show::Shadow, static_cast<float>(within(limits::exposure)),
                     static_cast<float>(within(limits::ambient))};
        s.time = within({0, 100});
        s.timeStep = coin() ? within({0, 1}) : 0;
        s.seed = std::uniform_int_distribution<uint32_t>()(random_);
        s.size = {whole(1, 16384), whole(1, 16384)};
        return s;
    }
    Shot shot() { return {whole(1, 1000000), coin() ? "shadow" : "", whole(0, 2047), whole(0, 14), coin()}; }

private:
    std::mt19937 random_{3};
};

} // namespace

TEST_CASE("every fact of a session comes back from a picture") {
    const TemporaryFolder folder;
    Dice dice;
    const auto scene = emptyScene();
    for (int round = 0; round < 40; ++round) {
        const Session written = dice.session(scene);
        const Shot shot = dice.shot();
        const Json facts = factsOf(written, shot, "a driver");
        const auto file = folder / (round % 2 ? "a.png" : "a.exr");
        writePicture(file, {1, 1, {"grey"}, {0}}, facts);

        Session read = dice.session(scene);
        const Shot shotRead = PictureFacts(file).restore(read);
        CHECK(factsOf(read, shotRead, "a driver") == facts);
        // Told apart from the writer: what decides the picture, to the last bit.
        CHECK(read.camera == written.camera);
        CHECK(read.light == written.light);
        CHECK(read.furtherLights == written.furtherLights);
        CHECK(read.ground == written.ground);
        CHECK(read.display.show == written.display.show);
        CHECK(read.display.exposure == written.display.exposure);
        CHECK(read.display.ambient == written.display.ambient);
        CHECK(read.techniques.parameters() == written.techniques.parameters());
        CHECK(read.comparison.against == written.comparison.against);
        if (written.comparison.against != Against::Nothing) CHECK(read.comparison == written.comparison);
        if (written.comparison.against == Against::Technique)
            CHECK(read.rival.parameters() == written.rival.parameters());
        CHECK(read.time == written.time);
        CHECK(read.timeStep == written.timeStep);
        CHECK(read.seed == written.seed);
        CHECK(read.size == written.size);
        CHECK(shotRead.frames == shot.frames);
        CHECK(shotRead.buffer == shot.buffer);
        CHECK(shotRead.layer == shot.layer);
        CHECK(shotRead.level == shot.level);
        CHECK(shotRead.panels == shot.panels);
        // What was at its default is so again, and follows it.
        for (const Parameter* p : read.techniques.parameters().all())
            CHECK(p->changed() == written.techniques.parameters().at(p->spec().id).changed());
    }
}

TEST_CASE("every built-in scene has facts that can be read again") {
    const TemporaryFolder folder;
    for (const std::string& name : builtInScenes()) {
        INFO(name);
        Session session;
        session.setScene(std::make_shared<const Scene>(importGltf(findScene(name))));
        writePicture(folder / "a.png", {1, 1, {"grey"}, {0}}, factsOf(session, {}, "a driver"));
        const PictureFacts facts(folder / "a.png");
        CHECK(facts.scene() == findScene(name));
        CHECK(facts.doubtAboutScene(*session.scene).empty());
        CHECK(facts.doubtAboutDriver("a driver").empty());
        CHECK(contains(facts.doubtAboutDriver("another"), "a driver"));
    }
}
