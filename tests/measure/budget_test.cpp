// SPDX-License-Identifier: MIT
// The search on costs and errors that are known, so that its answer is too.
#include "renderer/measure/budget.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <cmath>

using namespace penumbra;
using namespace penumbra::test;

namespace {

constexpr std::string_view shapes[] = {"plain", "good", "bad"};

struct SampleParameters : ParameterSet {
    Integer taps{*this, {.id = "taps", .value = 16, .min = 1, .max = 64}};
    Integer size{*this, {.id = "size", .value = 1024, .min = 16, .max = 16384, .scale = Scale::Logarithmic}};
    Real width{*this, {.id = "width", .value = 1, .min = 0, .max = 4}};
    Parameter shape{*this, Parameter::Type::Choice, {.id = "shape", .choices = shapes}};
    Integer onlyBad{*this,
                    {.id = "only-bad",
                     .min = 0,
                     .max = 9,
                     .active = [](const ParameterSet& set) { return set.at("shape").value() == 2; }}};
};

class Sample final : public Technique {
public:
    ParameterSet& parameters() override { return parameters_; }
    Image build(Flow&, Scope, const Inputs&) const override { throw InputError("nobody draws it"); }

private:
    SampleParameters parameters_;
};

const Card sample{.id = "sample", .make = [] { return std::unique_ptr<Technique>(new Sample); }};
const Card other{.id = "other", .make = [] { return std::unique_ptr<Technique>(new Sample); }};

double at(const Setting& setting, std::string_view id) { return setting.parameters().at(id).value(); }

// Cost and error of settings.
struct World {
    std::function<double(const Setting&)> cost, error;
    double noise = 0; // of quick looks, relative
    size_t asked = 0, cancelAfter = 1000000;

    Evaluate evaluate() {
        return [this](std::span<const Trial> trials, bool carefully) {
            if (asked + trials.size() > cancelAfter) trials = trials.first(cancelAfter - asked); // cancelled
            const size_t first = asked;
            asked += trials.size();
            std::vector<Outcome> outcomes;
            for (const Trial& trial : trials) {
                const double number = static_cast<double>(first + outcomes.size());
                const double wobble = carefully ? 0 : noise * std::sin(12.9898 * number);
                Outcome outcome;
                outcome.cost = cost(trial.setting) * (1 + wobble);
                outcome.interval = {0.99 * outcome.cost, 1.01 * outcome.cost, 0.97};
                outcome.error = error(trial.setting);
                outcomes.push_back(outcome);
            }
            return outcomes;
        };
    }
};

BudgetSearch search(World& world, std::string_view free, Budget budget,
                    std::initializer_list<const Card*> cards = {&sample}) {
    std::vector<Setting> starts;
    for (const Card* card : cards) starts.emplace_back(*card);
    return searchBudget(starts, parseFree(free), budget, world.evaluate());
}

} // namespace

TEST_CASE("along one parameter the search ends at the bound, to a whole tap") {
    World world{[](const Setting& s) { return 1 + 0.1 * at(s, "taps"); },
                [](const Setting& s) { return 1 / at(s, "taps"); }};
    const BudgetSearch within = search(world, "taps", {Bound::Cost, 4.75});
    REQUIRE(within.proposal);
    CHECK(at(within.trials[*within.proposal].setting, "taps") == 37);
    CHECK(within.trials[*within.proposal].careful);
    CHECK(within.complete);
    CHECK(within.certain); // 4.7 ms, at most 4.747
    const BudgetSearch exact = search(world, "taps", {Bound::Cost, 4.71});
    REQUIRE(exact.proposal);
    CHECK(at(exact.trials[*exact.proposal].setting, "taps") == 37);
    CHECK_FALSE(exact.certain);
    const BudgetSearch close = search(world, "taps", {Bound::Error, 0.0501});
    REQUIRE(close.proposal);
    CHECK(at(close.trials[*close.proposal].setting, "taps") == 20);
}

TEST_CASE("along two parameters the search follows the bound to the least error") {
    // Lagrange: with cost t + s and error 1/t + 4/s the least error at t + s = 30 is at t = 10, s = 20.
    World world{[](const Setting& s) { return at(s, "taps") + at(s, "size") / 100; },
                [](const Setting& s) { return 1 / at(s, "taps") + 400 / at(s, "size"); }};
    const BudgetSearch found = search(world, "taps,size", {Bound::Cost, 30});
    REQUIRE(found.proposal);
    const Trial& best = found.trials[*found.proposal];
    CHECK(best.outcome.cost <= 30);
    CHECK(best.outcome.error < 1.03 * (1.0 / 10 + 4.0 / 20));
    CHECK(found.trials.size() < mostTrials + 20);
}

TEST_CASE("continuous parameters, choices and those without effect are searched too") {
    World world{[](const Setting& s) { return at(s, "shape") == 2 ? 0.5 : 1.0; },
                [](const Setting& s) {
                    const double x = at(s, "width") - 2.7;
                    return 0.01 + x * x + (at(s, "shape") == 1 ? 0 : 0.2);
                }};
    const BudgetSearch found = search(world, "width,shape,only-bad", {Bound::Cost, 2});
    REQUIRE(found.proposal);
    const Setting& best = found.trials[*found.proposal].setting;
    CHECK(best.parameters().at("shape").text() == "good");
    CHECK(at(best, "width") == Approx(2.7).margin(0.05));
    for (const Trial& trial : found.trials)
        CHECK((at(trial.setting, "shape") == 2 || at(trial.setting, "only-bad") == 0));
    for (size_t i = 0; i < found.trials.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            CHECK_FALSE(found.trials[i].setting.parameters() == found.trials[j].setting.parameters());
}

TEST_CASE("of several techniques the cheapest that is as good is proposed") {
    World world{[](const Setting& s) { return s.card == &other ? 2.0 : 3.0; },
                [](const Setting& s) { return s.card == &other ? 0.1004 : 0.1; }};
    const BudgetSearch found = search(world, "taps", {Bound::Cost, 5}, {&sample, &other});
    REQUIRE(found.proposal);
    CHECK(found.trials[*found.proposal].setting.card == &other);
    const BudgetSearch close = search(world, "taps", {Bound::Error, 0.1002}, {&sample, &other});
    REQUIRE(close.proposal);
    CHECK(close.trials[*close.proposal].setting.card == &sample);
}

TEST_CASE("nothing is proposed where nothing keeps the budget, and what is not known keeps none") {
    World world{[](const Setting&) { return 10.0; }, [](const Setting& s) { return 1 / at(s, "taps"); }};
    CHECK_FALSE(search(world, "taps", {Bound::Cost, 5}).proposal);
    world.cost = [](const Setting& s) { return at(s, "taps") < 32 ? std::nan("") : 1.0; };
    world.error = [](const Setting& s) { return at(s, "taps"); };
    const BudgetSearch found = search(world, "taps", {Bound::Cost, 5});
    REQUIRE(found.proposal);
    CHECK(at(found.trials[*found.proposal].setting, "taps") == 32);
}

TEST_CASE("a lucky quick look is not believed") {
    World world{[](const Setting& s) { return at(s, "taps"); }, [](const Setting& s) { return 1 / at(s, "taps"); }, 0.1};
    const BudgetSearch found = search(world, "taps", {Bound::Cost, 30});
    REQUIRE(found.proposal);
    const Trial& best = found.trials[*found.proposal];
    CHECK(best.careful);
    CHECK(best.outcome.cost == at(best.setting, "taps"));
    CHECK(best.outcome.cost <= 30);
    CHECK(best.outcome.cost >= 24);
}

TEST_CASE("a search that is cancelled keeps what was tried and proposes the best so far") {
    World world{[](const Setting& s) { return at(s, "taps"); }, [](const Setting& s) { return 1 / at(s, "taps"); }};
    world.cancelAfter = 13;
    const BudgetSearch found = search(world, "taps", {Bound::Cost, 30});
    CHECK_FALSE(found.complete);
    CHECK(found.trials.size() == 13);
    for (const Trial& trial : found.trials) CHECK(std::isfinite(trial.outcome.cost));
    REQUIRE(found.proposal);
    CHECK(found.trials[*found.proposal].outcome.cost <= 30);
}

TEST_CASE("ranges of free parameters are kept, and bad ones refused") {
    World world{[](const Setting& s) { return at(s, "width"); }, [](const Setting& s) { return 1 / at(s, "width"); }};
    const BudgetSearch found = search(world, "width=0.3:1.7", {Bound::Cost, 9});
    REQUIRE(found.proposal);
    CHECK(at(found.trials[*found.proposal].setting, "width") == 1.7);
    for (const Trial& trial : found.trials)
        CHECK((at(trial.setting, "width") >= 0.3 && at(trial.setting, "width") <= 1.7));
    const auto refused = [&](std::string_view free) {
        return refusal([&] { search(world, free, {Bound::Cost, 9}); });
    };
    CHECK(contains(refused("widht"), "did you mean 'width'?"));
    CHECK(contains(refused("width=0.3:5"), "0..4"));
    CHECK(contains(refused("width=2:1"), "FROM of 'width=2:1'"));
    CHECK(contains(refused("width=a:1"), "'a'"));
    CHECK(contains(refused("width,"), "NAME=FROM:TO"));
    CHECK(contains(refused("width=3"), "NAME=FROM:TO"));
    CHECK(contains(refused("pcf.kernel"), "no technique that is measured"));
}
