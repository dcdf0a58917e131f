// SPDX-License-Identifier: MIT
#include "renderer/measure/budget.h"

#include "renderer/core/slider_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra {
namespace {

constexpr size_t coarse = 32;          // points of the grid, without choices
constexpr size_t mostCoarse = 64;      // with them
constexpr size_t beginnings = 2;       // of pattern searches, of each technique
constexpr double finest = 0.01;        // step, as a share of the range
constexpr size_t compared = 6;         // settings in the last comparison
constexpr ptrdiff_t comparedOfOne = 3; // technique
constexpr int comparisons = 3;         // at most, until one of them keeps the budget
constexpr double equalErrors = 0.01;   // relative difference that nobody sees
constexpr int quickFrames = 6;         // fewer have no interval of the median at 95 percent
constexpr int carefulFrames = 20;
constexpr size_t sideBySide = 8; // that are measured, so that results keep coming

// A free parameter of one technique.
struct Axis {
    std::string_view id;
    double from, to;             // its ends
    double low = 0, high = 1;    // the same as positions in [0, 1] on the parameter's scale
    std::vector<double> choices; // of a flag or an enumeration; else empty
};

Axis axisOf(Parameter& parameter, const FreeParameter& free) {
    const Spec& spec = parameter.spec();
    Axis axis{spec.id, free.from.value_or(spec.min), free.to.value_or(spec.max)};
    for (const double end : {axis.from, axis.to})
        if (!(end >= spec.min && end <= spec.max)) parameter.set(end); // refused with the range
    if (parameter.type() == Parameter::Type::Flag || parameter.type() == Parameter::Type::Choice) {
        for (double v = std::ceil(axis.from); v <= axis.to; ++v) axis.choices.push_back(v);
    } else {
        axis.low = sliderPosition(spec, axis.from);
        axis.high = sliderPosition(spec, axis.to);
    }
    return axis;
}

// Of one technique. A point is a position on each axis: in [low, high], or the value of a choice.
using Point = std::vector<double>;

class Space {
public:
    Space(const Setting& start, std::span<const FreeParameter> free) : start_(start.copy()) {
        const Setting scratch = start.copy();
        for (const FreeParameter& f : free) {
            Parameter* parameter = findParameter(scratch, f.name);
            const auto isKnown = [&](const Axis& axis) { return axis.id == parameter->spec().id; };
            if (parameter && std::none_of(axes_.begin(), axes_.end(), isKnown))
                axes_.push_back(axisOf(*parameter, f));
        }
    }

    const std::vector<Axis>& axes() const { return axes_; }

    Setting at(const Point& point) const {
        Setting setting = start_.copy();
        // Choices first: they decide which of the others have an effect.
        for (const bool choices : {true, false})
            for (size_t i = 0; i < axes_.size(); ++i) {
                if (axes_[i].choices.empty() == choices) continue;
                Parameter& parameter = setting.parameters().at(axes_[i].id);
                if (parameter.active()) setting.set(parameter, parameter.textOf(valueOn(i, point[i])));
            }
        return setting;
    }

    Point start() const {
        Point point;
        for (const Axis& axis : axes_) {
            const Parameter& parameter = start_.parameters().at(axis.id);
            const double value = parameter.value();
            if (axis.choices.empty())
                point.push_back(std::clamp(sliderPosition(parameter.spec(), value), axis.low, axis.high));
            else
                point.push_back(std::clamp(value, axis.choices.front(), axis.choices.back()));
        }
        return point;
    }

    // Choices in every combination, as far as there are not too many, and a grid of the others or, of many, points
    // spread evenly: multiples of powers of the root φ of x^(n+1) = x + 1 (the Rn sequence: Roberts 2018).
    std::vector<Point> coarsePoints() const {
        size_t numbers = 0, combinations = 1;
        for (const Axis& axis : axes_) {
            if (axis.choices.empty())
                ++numbers;
            else
                combinations *= axis.choices.size();
        }
        const size_t room = std::max<size_t>(std::min(coarse, mostCoarse / std::min(combinations, mostCoarse)), 1);
        size_t levels = 1;
        while (numbers > 0 && levels < 9 &&
               std::pow(static_cast<double>(levels + 1), static_cast<double>(numbers)) <= static_cast<double>(room))
            ++levels;
        const bool grid = levels >= 3 || numbers == 0;
        size_t count = grid ? 1 : room;
        for (size_t i = 0; grid && i < numbers; ++i) count *= levels;
        double phi = 1.5;
        for (int i = 0; i < 64; ++i) phi = std::pow(1 + phi, 1.0 / static_cast<double>(numbers + 1));

        std::vector<Point> points{start()};
        const size_t all = std::min(count * combinations, mostCoarse);
        for (size_t p = 0; p < all; ++p) {
            Point point;
            size_t place = p % count, combination = p / count;
            double power = 1;
            for (const Axis& axis : axes_) {
                if (!axis.choices.empty()) {
                    point.push_back(axis.choices[combination % axis.choices.size()]);
                    combination /= axis.choices.size();
                    continue;
                }
                power /= phi;
                const double spread = std::fmod(0.5 + static_cast<double>(p % count + 1) * power, 1.0);
                const double share =
                    grid ? static_cast<double>(place % levels) / static_cast<double>(levels - 1) : spread;
                place /= std::max<size_t>(levels, 1);
                point.push_back(std::lerp(axis.low, axis.high, share));
            }
            points.push_back(point);
        }
        return points;
    }

    // Those a step away along an axis or along two at once, and with another choice. A step of a parameter that has
    // steps of its own is one of those at least.
    std::vector<Point> neighbours(const Point& centre, double step) const {
        std::vector<Point> points;
        std::vector<size_t> numbers;
        for (size_t i = 0; i < axes_.size(); ++i) {
            if (axes_[i].choices.empty()) numbers.push_back(i);
            for (const double choice : axes_[i].choices)
                if (choice != centre[i]) points.push_back(with(centre, i, choice));
        }
        for (const size_t i : numbers)
            for (const int way : {-1, 1}) points.push_back(with(centre, i, moved(i, centre[i], way * step)));
        for (const size_t i : numbers)
            for (const size_t j : numbers)
                if (i != j)
                    points.push_back(
                        with(with(centre, i, moved(i, centre[i], step)), j, moved(j, centre[j], -step)));
        std::erase(points, centre);
        return points;
    }

private:
    static Point with(Point point, size_t axis, double position) {
        point[axis] = position;
        return point;
    }

    double valueOn(size_t i, double position) const {
        const Axis& axis = axes_[i];
        if (!axis.choices.empty()) return position;
        const Parameter& parameter = start_.parameters().at(axis.id);
        const Spec& spec = parameter.spec();
        if (position <= axis.low) return parameter.nearest(axis.from);
        if (position >= axis.high) return parameter.nearest(axis.to);
        const double value = sliderValue(spec, position);
        return parameter.nearest(spec.step == 0 ? roundForHand(spec, value) : value); // that people can read
    }

    double moved(size_t i, double from, double step) const {
        const Axis& axis = axes_[i];
        const Spec& spec = start_.parameters().at(axis.id).spec();
        double to = std::clamp(from + step * (axis.high - axis.low), axis.low, axis.high);
        if (spec.step > 0 && valueOn(i, to) == valueOn(i, from))
            to = std::clamp(sliderPosition(spec, valueOn(i, from) + std::copysign(spec.step, step)), axis.low,
                            axis.high);
        return to;
    }

    Setting start_;
    std::vector<Axis> axes_;
};

class Search {
public:
    Search(const Budget& budget, const Evaluate& evaluate) : budget_(budget), evaluate_(evaluate) {}

    BudgetSearch run(std::span<const Space> spaces) {
        try {
            for (const Space& space : spaces) explore(space);
            compare();
        } catch (const Cancelled&) {
            search_.complete = false;
        }
        propose();
        return std::move(search_);
    }

private:
    Bound other() const { return budget_.bound == Bound::Cost ? Bound::Error : Bound::Cost; }
    bool keeps(const Outcome& outcome) const { return outcome.of(budget_.bound) <= budget_.limit; } // NaN: no
    const Outcome& outcome(size_t trial) const { return search_.trials[trial].outcome; }

    bool better(size_t a, size_t b) const {
        const Outcome &x = outcome(a), &y = outcome(b);
        if (keeps(x) != keeps(y)) return keeps(x);
        const auto less = [](double p, double q) { return p < q || (!std::isnan(p) && std::isnan(q)); };
        if (keeps(x) && x.of(other()) != y.of(other())) return less(x.of(other()), y.of(other()));
        return less(x.of(budget_.bound), y.of(budget_.bound));
    }

    // The trials of these points, tried now unless they were before.
    std::vector<size_t> attempt(const Space& space, std::span<const Point> points) {
        std::vector<size_t> places;
        const size_t known = search_.trials.size();
        for (const Point& point : points) {
            Setting setting = space.at(point);
            size_t place = 0;
            while (place < search_.trials.size() && !(search_.trials[place].setting.parameters() == setting.parameters()))
                ++place;
            if (place == search_.trials.size()) {
                setting.place = place;
                search_.trials.push_back({std::move(setting), {}});
            }
            places.push_back(place);
        }
        if (search_.trials.size() > known) {
            const std::span<Trial> fresh(search_.trials.begin() + static_cast<ptrdiff_t>(known), search_.trials.end());
            const std::vector<Outcome> outcomes = evaluate_(fresh, false);
            for (size_t i = 0; i < outcomes.size(); ++i) fresh[i].outcome = outcomes[i];
            if (outcomes.size() < fresh.size()) {
                search_.trials.erase(search_.trials.begin() + static_cast<ptrdiff_t>(known + outcomes.size()),
                                     search_.trials.end());
                throw Cancelled{};
            }
        }
        return places;
    }

    void explore(const Space& space) {
        const size_t first = search_.trials.size();
        const std::vector<Point> points = space.axes().empty() ? std::vector<Point>{space.start()} : space.coarsePoints();
        std::vector<std::pair<size_t, Point>> tried;
        const std::vector<size_t> places = attempt(space, points);
        for (size_t i = 0; i < points.size(); ++i) tried.emplace_back(places[i], points[i]);
        std::stable_sort(tried.begin(), tried.end(),
                         [&](const auto& a, const auto& b) { return better(a.first, b.first); });
        tried.erase(std::unique(tried.begin(), tried.end(),
                                [](const auto& a, const auto& b) { return a.first == b.first; }),
                    tried.end());
        if (space.axes().empty()) return;
        const size_t begin = keeps(outcome(tried[0].first)) ? beginnings : 1;
        for (size_t i = 0; i < std::min(begin, tried.size()); ++i) {
            auto [best, centre] = tried[i];
            for (double step = 0.125; step >= finest;) {
                if (search_.trials.size() - first >= mostTrials) return;
                const std::vector<Point> around = space.neighbours(centre, step);
                const std::vector<size_t> there = attempt(space, around);
                const size_t before = best;
                for (size_t k = 0; k < there.size(); ++k)
                    if (better(there[k], best)) best = there[k], centre = around[k];
                if (best == before) step /= 2;
            }
        }
    }

    std::vector<size_t> ranked() const {
        std::vector<size_t> places(search_.trials.size());
        for (size_t i = 0; i < places.size(); ++i) places[i] = i;
        std::stable_sort(places.begin(), places.end(), [&](size_t a, size_t b) { return better(a, b); });
        return places;
    }

    // Quick looks are kind to those that were lucky: the best are looked at again.
    void compare() {
        for (int round = 0; round < comparisons; ++round) {
            std::vector<size_t> places;
            for (const size_t place : ranked()) {
                const Trial& trial = search_.trials[place];
                const auto same = std::count_if(places.begin(), places.end(), [&](size_t p) {
                    return search_.trials[p].setting.card == trial.setting.card;
                });
                if (keeps(trial.outcome) && !trial.careful && same < comparedOfOne && places.size() < compared)
                    places.push_back(place);
            }
            if (places.empty()) return;
            std::vector<Trial> again;
            for (const size_t place : places) {
                again.push_back({search_.trials[place].setting.copy(), {}, true});
                again.back().setting.place = place;
            }
            const std::vector<Outcome> outcomes = evaluate_(again, true);
            for (size_t i = 0; i < outcomes.size(); ++i) {
                search_.trials[places[i]].outcome = outcomes[i];
                search_.trials[places[i]].careful = true;
            }
            if (outcomes.size() < places.size()) throw Cancelled{};
            if (std::any_of(places.begin(), places.end(), [&](size_t place) { return keeps(outcome(place)); })) return;
        }
    }

    // Whether the difference from the better one is none.
    bool equals(const Outcome& a, const Outcome& best) const {
        if (budget_.bound == Bound::Cost) return a.error <= best.error * (1 + equalErrors);
        return a.interval.low <= best.interval.high;
    }

    void propose() {
        const std::vector<size_t> places = ranked();
        const bool careful = std::any_of(places.begin(), places.end(), [&](size_t place) {
            return search_.trials[place].careful && keeps(outcome(place));
        });
        for (const size_t place : places) {
            const Outcome& found = outcome(place);
            if (!keeps(found) || (careful && !search_.trials[place].careful)) continue;
            if (!search_.proposal)
                search_.proposal = best_ = place;
            else if (equals(found, outcome(best_)) &&
                     found.of(budget_.bound) < outcome(*search_.proposal).of(budget_.bound))
                search_.proposal = place; // as good, and cheaper or closer
        }
        if (search_.proposal && budget_.bound == Bound::Cost)
            search_.certain = outcome(*search_.proposal).interval.high <= budget_.limit;
    }

    const Budget budget_;
    const Evaluate& evaluate_;
    BudgetSearch search_;
    size_t best_ = 0;
};

std::vector<Space> spacesOf(std::span<const Setting> starts, std::span<const FreeParameter> free) {
    std::vector<Space> spaces;
    for (const Setting& start : starts) spaces.emplace_back(start, free);
    return spaces;
}

double number(std::string_view text, std::string_view whole) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError(fmt::format("--free: '{}' of '{}' is not a number", text, whole));
    return value;
}

// Measures the settings in all views and puts together the dearest of each and the worst errors; nothing if it was
// cancelled.
std::optional<std::vector<SettingResult>> worstOf(std::vector<Measurer>& views, std::span<const Trial> trials,
                                                  bool carefully, Measurer::Share share) {
    std::vector<SettingResult> worst;
    double viewsDone = 0;
    for (Measurer& view : views) {
        const auto shareOf = [&](double v) { return std::lerp(share.from, share.to, v / double(views.size())); };
        std::vector<Setting> settings;
        for (const Trial& trial : trials) {
            settings.push_back(trial.setting.copy());
            settings.back().place = trial.setting.place;
        }
        Measurement measurement = view.measure(std::move(settings), carefully ? carefulFrames : quickFrames,
                                               {shareOf(viewsDone), shareOf(viewsDone + 1)});
        ++viewsDone;
        if (!measurement.complete) return std::nullopt;
        if (worst.empty()) {
            worst = std::move(measurement.results);
            continue;
        }
        for (size_t i = 0; i < worst.size(); ++i) {
            SettingResult& here = measurement.results[i];
            // What is not known in one view is not known of all.
            if (!worst[i].trouble.empty() || !here.trouble.empty()) {
                if (worst[i].trouble.empty()) worst[i] = std::move(here);
                continue;
            }
            const Errors errors =
                here.errors->all.rmse > worst[i].errors->all.rmse ? *here.errors : *worst[i].errors;
            if (median(here.costs) > median(worst[i].costs)) worst[i] = std::move(here);
            worst[i].errors = errors;
        }
    }
    return worst;
}

Outcome outcomeOf(const SettingResult& result) {
    Outcome outcome;
    if (!result.costs.empty()) {
        const TimeSummary cost = summarise(result.costs);
        outcome.cost = cost.median;
        outcome.interval = cost.interval;
    }
    if (result.errors) outcome.error = result.errors->all.rmse;
    outcome.trouble = result.trouble;
    return outcome;
}

} // namespace

std::vector<FreeParameter> parseFree(std::string_view text) {
    std::vector<FreeParameter> all;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view piece = text.substr(begin, end - begin);
        begin = end + 1;
        const size_t equals = piece.find('='), colon = piece.find(':');
        FreeParameter free{std::string(piece.substr(0, equals)), {}, {}};
        if (free.name.empty() || (equals != std::string_view::npos) != (colon != std::string_view::npos) ||
            (colon != std::string_view::npos && colon < equals))
            throw InputError(fmt::format("--free: '{}' is not NAME or NAME=FROM:TO", piece));
        if (equals != std::string_view::npos) {
            free.from = number(piece.substr(equals + 1, colon - equals - 1), piece);
            free.to = number(piece.substr(colon + 1), piece);
            if (*free.from >= *free.to)
                throw InputError(fmt::format("--free: FROM of '{}' is not below TO", piece));
        }
        all.push_back(std::move(free));
    }
    return all;
}

size_t checkFree(std::span<const Setting> starts, std::span<const FreeParameter> free) {
    for (const FreeParameter& f : free) {
        requireParameter(starts, f.name);
        if (std::none_of(starts.begin(), starts.end(), [&](const Setting& s) { return findParameter(s, f.name); }))
            throw InputError(fmt::format("--free: '{}' is of no technique that is measured", f.name));
    }
    size_t trials = 0;
    for (const Space& space : spacesOf(starts, free)) trials += space.axes().empty() ? 1 : mostTrials;
    return trials;
}

BudgetSearch searchBudget(std::span<const Setting> starts, std::span<const FreeParameter> free, const Budget& budget,
                          const Evaluate& evaluate) {
    checkFree(starts, free);
    return Search(budget, evaluate).run(spacesOf(starts, free));
}

Evaluate measuredIn(std::vector<Measurer>& views, size_t expected, std::function<void(SettingResult)> tried) {
    return [&views, tried = std::move(tried), done = size_t{0}, expected](std::span<const Trial> trials,
                                                                          bool carefully) mutable {
        std::vector<Outcome> outcomes;
        for (size_t first = 0; first < trials.size(); first += sideBySide) {
            const auto some = trials.subspan(first, std::min(sideBySide, trials.size() - first));
            // The last comparison, of which nobody knew, is the end.
            const auto share = [&](size_t trial) {
                return std::min(static_cast<double>(trial) / static_cast<double>(std::max<size_t>(expected, 1)), 0.95);
            };
            const double from = share(done), to = carefully ? 1 : share(done + some.size());
            done += some.size();
            std::optional<std::vector<SettingResult>> results = worstOf(views, some, carefully, {from, to});
            if (!results) break; // cancelled
            for (SettingResult& result : *results) {
                outcomes.push_back(outcomeOf(result));
                tried(std::move(result));
            }
        }
        return outcomes;
    };
}

} // namespace penumbra
