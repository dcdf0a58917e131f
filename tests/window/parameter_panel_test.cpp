// SPDX-License-Identifier: MIT
// The panel is used with a mouse, without a window: ImGui only needs to be told where the pointer is.
#include "tests/catch.h"

#include "ui/parameter_panel.h"

#include "renderer/core/technique.h"

using namespace penumbra;

namespace {

constexpr float width = 400, height = 1600;

class Panel {
public:
    explicit Panel(ParameterSet& set) : set_(set) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {width, height};
        io.DeltaTime = 1.0f / 60;
        loadFont(15);
        unsigned char* pixels = nullptr;
        int w = 0, h = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &w, &h);
        applyTheme(1);
        frame(0, 0, false);
    }
    ~Panel() { ImGui::DestroyContext(); }

    void frame(float x, float y, bool pressed) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {x, y};
        io.MouseDown[0] = pressed;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({width, height});
        ImGui::Begin("panel", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
        panel_.draw(set_);
        ImGui::End();
        ImGui::Render();
    }

    void click(float x, float y) {
        frame(x, y, false);
        frame(x, y, true);
        frame(x, y, false);
    }
    void rest() { // so that two clicks are no double click
        for (int i = 0; i < 30; ++i) frame(0, 0, false);
    }
    void type(const std::string& characters) {
        for (const char c : characters) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c));
        frame(0, 0, false);
        key(ImGuiKey_Enter);
    }
    void key(ImGuiKey key) {
        for (const bool down : {true, false}) {
#if IMGUI_VERSION_NUM >= 18700
            ImGui::GetIO().AddKeyEvent(key, down);
#else
            ImGui::GetIO().KeyMap[key] = key;
            ImGui::GetIO().KeysDown[key] = down;
#endif
            frame(0, 0, false);
        }
    }

    void drag(float y, float from, float to) {
        frame(from, y, false);
        frame(from, y, true);
        for (int i = 1; i <= 8; ++i) frame(from + (to - from) * static_cast<float>(i) / 8, y, true);
        frame(to, y, false);
        frame(to, y, false);
    }

private:
    ParameterSet& set_;
    ParameterPanel panel_;
};

enum class Shape { Round, Square };
constexpr std::string_view shapes[] = {"round", "square"};

struct Sample : ParameterSet {
    Real width{*this, {.id = "width", .symbol = "w", .value = 1, .min = 0.5, .max = 4, .unit = Unit::Metres}};
    Real share{*this, {.id = "share", .value = 50, .min = 0, .max = 100, .unit = Unit::Percent}};
    Real bias{*this,
              {.id = "bias",
               .symbol = "ε",
               .value = 1e-3,
               .min = 0,
               .max = 1,
               .scale = Scale::Logarithmic,
               .smallest = 1e-6}};
    Integer kernel{*this, {.id = "kernel", .value = 5, .min = 1, .max = 63, .step = 2, .unit = Unit::Texels}};
    Flag on{*this, {.id = "on", .value = 0}};
    Choice<Shape> shape{*this, {.id = "shape", .choices = shapes}};
    Real unused{*this,
                {.id = "unused",
                 .value = 0.5,
                 .active = [](const ParameterSet&) { return false; },
                 .inactiveReason = "nothing uses it"}};
};

} // namespace

TEST_CASE("dragging along every height of the panel moves each active slider and leaves valid values") {
    Sample set;
    Panel panel(set);
    std::vector<bool> moved(set.all().size());
    // Left of the reset buttons, over the right part of the controls.
    for (float y = 4; y < 500; y += 6)
        for (const float to : {360.0f, 180.0f, 300.0f}) {
            panel.drag(y, 260, to);
            for (size_t i = 0; i < set.all().size(); ++i) {
                Parameter& p = *set.all()[i];
                CAPTURE(p.spec().id, p.text(), y, to);
                REQUIRE_NOTHROW(p.set(p.value()));
                moved[i] = moved[i] || p.changed();
            }
        }
    for (const Parameter* p : {static_cast<Parameter*>(&set.width), static_cast<Parameter*>(&set.share),
                               static_cast<Parameter*>(&set.bias), static_cast<Parameter*>(&set.kernel)}) {
        const auto all = set.all();
        const size_t index = static_cast<size_t>(std::find(all.begin(), all.end(), p) - all.begin());
        CAPTURE(p->spec().id);
        CHECK(moved[index]);
    }
    CHECK_FALSE(set.unused.changed());
}

TEST_CASE("the panel of every technique can be dragged all over without a bad value") {
    for (const Card* card : catalogue()) {
        const auto technique = makeTechnique(*card);
        ParameterSet& set = technique->parameters();
        Panel panel(set);
        CAPTURE(card->id);
        for (float y = 4; y < 800; y += 9) panel.drag(y, 250, 340);
        for (Parameter* p : set.all()) {
            CAPTURE(p->spec().id, p->text());
            CHECK_NOTHROW(p->set(p->value()));
        }
        if (!set.all().empty()) CHECK_FALSE(set == makeTechnique(*card)->parameters());
    }
}

TEST_CASE("a double click on a slider takes a typed value, and refuses what is out of range") {
    Sample set;
    Panel panel(set);
    std::vector<bool> taken(set.all().size());
    for (float y = 4; y < 500; y += 6) {
        panel.rest();
        panel.click(250, y);
        panel.click(250, y);
        panel.type("2.5");
        for (size_t i = 0; i < set.all().size(); ++i) {
            const Parameter& p = *set.all()[i];
            CAPTURE(p.spec().id, p.text(), y);
            if (p.type() != Parameter::Type::Real && p.type() != Parameter::Type::Integer) continue;
            // The first click of the two moved the slider, but not for long.
            CHECK((p.value() == 2.5 || !p.changed()));
            taken[i] = taken[i] || p.value() == 2.5;
        }
        set.reset();
    }
    const auto wasTaken = [&](const Parameter& p) {
        const auto all = set.all();
        return taken[static_cast<size_t>(std::find(all.begin(), all.end(), &p) - all.begin())];
    };
    CHECK(wasTaken(set.width));
    CHECK(wasTaken(set.share));
    CHECK_FALSE(wasTaken(set.bias));   // 0..1
    CHECK_FALSE(wasTaken(set.kernel)); // odd
    CHECK_FALSE(wasTaken(set.unused));
}

TEST_CASE("one value, a group and all are reset, each by a button of its own") {
    const auto technique = makeTechnique(findCard("pcf"));
    ParameterSet& set = technique->parameters();
    Panel panel(set);
    const auto change = [&] {
        for (Parameter* p : set.all())
            p->set(p->nearest(p->defaultValue() == p->spec().max ? p->spec().min : p->spec().max));
    };
    const auto unchanged = [&] {
        std::vector<const Parameter*> found;
        for (const Parameter* p : set.all())
            if (!p->changed()) found.push_back(p);
        return found;
    };
    std::vector<std::vector<const Parameter*>> resets; // what each click brought back
    const ImGuiStyle& style = ImGui::GetStyle();
    for (float y = 4; y < 800; y += 5)
        for (const float x : {width - style.WindowPadding.x - 10, style.WindowPadding.x + 20}) {
            change();
            panel.rest();
            panel.click(x, y);
            resets.push_back(unchanged());
        }
    const auto happened = [&](const std::vector<const Parameter*>& wanted) {
        return std::find(resets.begin(), resets.end(), wanted) != resets.end();
    };
    std::vector<const Parameter*> all;
    for (const Parameter* p : set.all()) {
        all.push_back(p);
        CAPTURE(p->spec().id);
        CHECK(happened({p}));
        std::vector<const Parameter*> group;
        for (const Parameter* other : set.all())
            if (other->group() == p->group()) group.push_back(other);
        CHECK(happened(group));
    }
    CHECK(happened(all));
}
