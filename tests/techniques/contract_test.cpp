// SPDX-License-Identifier: MIT
// What is true of every technique of the catalogue.
#include "renderer/core/technique.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <random>

using namespace penumbra;
using namespace penumbra::test;

namespace {

std::shared_ptr<const Scene> emptyFloor(float tilt) { return SceneBuilder().floor(3, tilt).build(); }

// A slab that no ray from the light to the floor can pass.
std::shared_ptr<const Scene> lidOverFloor() {
    return SceneBuilder().floor(2).box({-6, 2.2f, -6}, {6, 2.4f, 6}).build();
}

std::shared_ptr<const Scene> boxesOverFloor() {
    return SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).box({0.2f, 0.8f, 0.2f}, {0.9f, 1.0f, 1.4f}).build();
}

bool hasHistory() { return !renderer().flow().pasts().empty(); } // what was drawn last

// ψ; empty where the driver has not that many samples a texel and refused them by their number.
std::vector<float> drawIfOffered(const Session& s) {
    try {
        return draw(s).psi.values;
    } catch (const InputError& error) {
        if (std::string_view(error.what()).find("this driver offers") == std::string_view::npos) throw;
        return {};
    }
}

// Finite and in [0, 1] everywhere, and silence from the driver.
void checkSane(const Session& s) {
    const auto check = [](const std::vector<float>& values) {
        double low = 1, high = 0;
        bool finite = true;
        for (const float psi : values) {
            finite = finite && std::isfinite(psi);
            low = std::min<double>(low, psi);
            high = std::max<double>(high, psi);
        }
        CHECK(finite);
        CHECK(low >= 0);
        CHECK(high <= 1);
    };
    check(drawIfOffered(s));
    if (hasHistory()) {
        renderer().render(s);
        check(renderer().read(renderer().shadow()).values);
    }
    CHECK(driverMessages().empty());
}

// ψ of a first frame. Of a technique with a history, of many: camera, things and light move, and then come to rest.
std::vector<float> shown(Session& s) {
    std::vector<float> values = drawIfOffered(s);
    if (!hasHistory()) return values;
    const Camera camera = s.camera;
    const AreaLight light = s.light;
    for (int frame = 1; frame < 20; ++frame) {
        if (frame < 4) s.camera.eye.x += 0.2f, s.camera.target.x += 0.2f;
        if (frame == 5) s.light.position.x += 0.1f;
        if (frame > 5 && frame < 10) s.time += 0.08;
        renderer().render(s);
        const std::vector<float> psi = renderer().read(renderer().shadow()).values;
        values.insert(values.end(), psi.begin(), psi.end());
    }
    s.camera = camera, s.light = light, s.time = 0;
    return values;
}

// Puts a parameter back where it was.
class Restored {
public:
    explicit Restored(Parameter& p) : p_(p), value_(p.value()), changed_(p.changed()) {}
    ~Restored() { changed_ ? p_.set(value_) : p_.reset(); } // a default may hang on other parameters
    Restored(const Restored&) = delete;
    Restored& operator=(const Restored&) = delete;

private:
    Parameter& p_;
    double value_;
    bool changed_;
};

bool tooLarge(const Parameter& p, double value) { return p.spec().id == "map-size" && value > quickMap; }

} // namespace

TEST_CASE("the empty floor is lit, level and at 45 degrees") {
    for (const Card* card : catalogue())
        for (const float tilt : {0.0f, 45.0f})
            for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
                Session s = session(emptyFloor(tilt), card->id);
                s.light.shape = shape;
                if (shape == LightShape::Directional) s.light.size = {2, 0};
                CAPTURE(card->id, tilt, int(shape));
                const double mean = draw(s).meanOverSurface();
                CHECK(mean <= card->litTolerance);
            }
    CHECK(driverMessages().empty());
}

TEST_CASE("a closed lid makes the floor dark") {
    for (const Card* card : catalogue())
        for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
            Session s = quickSession(lidOverFloor(), card->id);
            s.camera = {.eye = {1.5f, 1.2f, 1.5f}, .target = {0, 0, 0}, .fovY = 30};
            s.light.shape = shape;
            if (shape == LightShape::Directional) s.light.size = {2, 0};
            CAPTURE(card->id, int(shape));
            CHECK(1 - draw(s).meanOverSurface() <= card->lidTolerance);
        }
    CHECK(driverMessages().empty());
}

TEST_CASE("a surface turned away from the whole light is dark without any map") {
    for (const Card* card : catalogue()) {
        Session s = session(SceneBuilder().floor(1).build(), card->id);
        s.camera.eye = {2, -2, 2}; // sees the floor's lower side, which the light above does not reach
        CAPTURE(card->id);
        CHECK(draw(s).meanOverSurface() == 1);
    }
}

TEST_CASE("every parameter at its minimum, default and maximum gives a finite ψ in [0, 1]") {
    for (const Card* card : catalogue()) {
        Session s = quickSession(boxesOverFloor(), card->id);
        for (Parameter* p : s.techniques.parameters().all()) {
            const Restored restored(*p);
            for (const double value :
                 {p->spec().min, p->defaultValue(),
                  std::min(p->spec().max, tooLarge(*p, p->spec().max) ? quickMap : p->spec().max)}) {
                CAPTURE(p->qualifiedName(), value);
                p->set(p->nearest(value));
                checkSane(s);
            }
        }
    }
}

TEST_CASE("random settings give a finite ψ in [0, 1]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const Card* card : catalogue()) {
        Session s = quickSession(boxesOverFloor(), card->id);
        for (int round = 0; round < 12; ++round) {
            for (Parameter* p : s.techniques.parameters().all()) {
                const double max = tooLarge(*p, p->spec().max) ? quickMap : p->spec().max;
                p->set(p->nearest(p->spec().min + unit(random) * (max - p->spec().min)));
            }
            s.light.shape = static_cast<LightShape>(round % 3);
            s.light.size = glm::vec2(static_cast<float>(std::pow(10, 4 * unit(random) - 3)));
            CAPTURE(card->id, round);
            checkSane(s);
        }
    }
}

TEST_CASE("extreme scenes, lights and views give a finite ψ in [0, 1]") {
    for (const Card* card : catalogue()) {
        CAPTURE(card->id);
        const auto with = [&](std::shared_ptr<const Scene> scene, auto&& change) {
            for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
                Session s = quickSession(scene, card->id);
                s.light.shape = shape;
                change(s);
                checkSane(s);
            }
        };
        SECTION(std::string(card->id) + ": light of no size") {
            with(boxesOverFloor(), [](Session& s) { s.light.size = {0, 0}; });
        }
        SECTION(std::string(card->id) + ": huge light") {
            with(boxesOverFloor(), [](Session& s) { s.light.size = {170, 170}; });
        }
        SECTION(std::string(card->id) + ": light inside a box") {
            with(boxesOverFloor(), [](Session& s) { s.light.position = {-0.5f, 0.5f, -0.5f}; });
        }
        SECTION(std::string(card->id) + ": light on the floor") {
            with(boxesOverFloor(), [](Session& s) { s.light.position = {1, 0, 1}; });
        }
        SECTION(std::string(card->id) + ": light at its own target") {
            with(boxesOverFloor(), [](Session& s) { s.light.position = s.light.target; });
        }
        SECTION(std::string(card->id) + ": everything behind the light") {
            with(boxesOverFloor(), [](Session& s) { s.light.target = {0, 9, 0}; });
        }
        SECTION(std::string(card->id) + ": depths from 1 mm to 1 km") {
            const auto scene = SceneBuilder().floor(1000).box({-1e-3f, 3.998f, -1e-3f}, {1e-3f, 3.999f, 1e-3f}).build();
            with(scene, [](Session&) {});
        }
        SECTION(std::string(card->id) + ": 6 mm wide") {
            const auto scene = SceneBuilder().floor(3e-3f).box({-1e-3f, 0, -1e-3f}, {0, 1e-3f, 0}).build();
            with(scene, [](Session& s) {
                s.camera = {.eye = {3e-3f, 3e-3f, 3e-3f}};
                s.light.position = {0, 6e-3f, 0};
                s.light.size = {1e-3f, 1e-3f};
            });
        }
        SECTION(std::string(card->id) + ": 2 km wide") {
            const auto scene = SceneBuilder().floor(1000).box({-300, 0, -300}, {0, 300, 0}).build();
            with(scene, [](Session& s) {
                s.camera = {.eye = {900, 900, 900}};
                s.light.position = {0, 2000, 0};
                if (s.light.shape != LightShape::Directional) s.light.size = {300, 300};
            });
        }
        SECTION(std::string(card->id) + ": degenerate triangles") {
            SceneBuilder builder;
            builder.floor(3).triangle({0, 1, 0}, {0, 1, 0}, {0, 1, 0}).triangle({0, 1, 0}, {1, 1, 0}, {2, 1, 0});
            builder.triangle({0, 1, 0}, {1, 1, 0}, {0.5f, 1, 1e-20f});
            with(builder.build(), [](Session&) {});
        }
        SECTION(std::string(card->id) + ": one pixel") {
            with(boxesOverFloor(), [](Session& s) { s.size = {1, 1}; });
        }
        SECTION(std::string(card->id) + ": odd picture") {
            with(boxesOverFloor(), [](Session& s) { s.size = {37, 23}; });
        }
        SECTION(std::string(card->id) + ": empty scene") {
            with(SceneBuilder().build(), [](Session&) {});
        }
        SECTION(std::string(card->id) + ": empty scene with ground") {
            with(SceneBuilder().build(), [](Session& s) { s.ground = true; });
        }
        SECTION(std::string(card->id) + ": eye inside a box") {
            with(boxesOverFloor(), [](Session& s) { s.camera.eye = {-0.5f, 0.5f, -0.5f}; });
        }
    }
}

TEST_CASE("the smallest map works") {
    for (const Card* card : catalogue()) {
        Session s = session(boxesOverFloor(), card->id);
        Parameter* size = s.techniques.parameters().find("map-size");
        if (!size) continue;
        size->set(size->spec().min);
        CAPTURE(card->id);
        checkSane(s);
    }
}

TEST_CASE("the largest map works, or is refused with its name and size") {
    for (const Card* card : catalogue()) {
        Session s = session(boxesOverFloor(), card->id);
        Parameter* size = s.techniques.parameters().find("map-size");
        if (!size) continue;
        size->set(size->spec().max);
        if (Parameter* kernel = s.techniques.parameters().find("kernel")) kernel->set(kernel->spec().min);
        s.size = {8, 8};
        CAPTURE(card->id);
        s.textureLimit = 256 << 20;
        const auto side = static_cast<int>(size->value());
        CHECK_THROWS_WITH(renderer().render(s),
                          contains("the limit is 256 MiB") && contains(fmt::format("{0}x{0}", side)));
        CHECK_FALSE(renderer().hasFrame());
        // Room for a depth map of 16384 texels a side and little more; what filters a map of 8192 is refused again.
        s.textureLimit = uint64_t(side > 8192 ? 1030 : 300) << 20;
        try {
            checkSane(s);
        } catch (const InputError& error) {
            CHECK_THAT(error.what(), contains("this driver's limit") || contains(fmt::format("{0}x{0}", side)));
        }
        s.techniques.parameters().reset();
        checkSane(s); // and the small one is back
    }
}

TEST_CASE("the same frame twice is the same to the last bit") {
    for (const Card* card : catalogue()) {
        const Session s = quickSession(boxesOverFloor(), card->id);
        const ShadowImage first = draw(s);
        CHECK((draw(s).psi.values == first.psi.values)); // in brackets: a failure does not print them all
    }
}

TEST_CASE("a parameter says that it is without effect exactly when no value of it changes the picture") {
    // The sheet is open, so that it matters which faces cast. The low plate is for biases of those that turn away.
    const auto scene =
        std::make_shared<Scene>(*SceneBuilder()
                                     .floor(3)
                                     .box({-1, 0, -1}, {0, 1, 0})
                                     .box({0.2f, 0.8f, 0.2f}, {0.9f, 1.0f, 1.4f})
                                     .box({0.3f, 0.02f, -1.3f}, {1.2f, 0.06f, -0.4f})
                                     .quad({-1, 0.5f, 0.5f}, {-1, 0.5f, 1.5f}, {0, 0.5f, 1.5f}, {0, 0.5f, 0.5f})
                                     .build());
    // The floor and the first box are one thing, which throws a shadow on itself.
    for (size_t i = 1; i < 14; ++i) {
        std::vector<Primitive>& triangle = scene->meshes[i].primitives;
        scene->meshes[0].primitives.insert(scene->meshes[0].primitives.end(), triangle.begin(), triangle.end());
        triangle.clear();
    }
    for (const Card* card : catalogue()) {
        Session s = quickSession(scene, card->id);
        s.light.position = {1.5f, 3, 1}; // slanting, so that biases matter
        const ParameterSet& set = s.techniques.parameters();
        (void)draw(s);
        const bool history = hasHistory();
        if (history) {
            s.scene = wavingScene(); // its board is open
            s.light.size = {2, 2};   // penumbrae that neighbours fit into
            set.at("map-size").set(128);
        }
        std::vector<bool> usually;
        for (const Parameter* p : set.all()) usually.push_back(p->active());
        const auto hasEffect = [&](Parameter& p, const std::vector<float>& plain) {
            const Restored restored(p);
            bool effect = false;
            for (const double share : {0.0, 0.1, 0.5, 1.0}) {
                const double value = p.nearest(p.spec().min + share * (p.spec().max - p.spec().min));
                if (effect || tooLarge(p, value)) continue;
                p.set(value);
                const std::vector<float> changed = shown(s);
                effect = !changed.empty() && changed != plain;
            }
            return effect;
        };
        const std::vector<float> plain = shown(s);
        for (Parameter* p : set.all()) {
            CAPTURE(p->qualifiedName());
            CHECK(hasEffect(*p, plain) == p->active());
        }
        for (Parameter* choice : set.all()) // what hangs on a choice or a switch
            if (choice->type() == Parameter::Type::Choice || choice->type() == Parameter::Type::Flag) {
                for (double value = 0; value <= choice->spec().max; ++value) {
                    choice->set(value);
                    CAPTURE(choice->qualifiedName(), choice->text());
                    const std::vector<float> chosen = shown(s);
                    if (chosen.empty()) continue;
                    for (size_t i = 0; i < set.all().size(); ++i) {
                        Parameter* p = set.all()[i];
                        if (!p->spec().active || (history && p->active() == usually[i])) continue;
                        CAPTURE(p->qualifiedName());
                        CHECK_FALSE(p->spec().inactiveReason.empty());
                        CHECK(hasEffect(*p, chosen) == p->active());
                    }
                }
                choice->reset();
            }
    }
}
