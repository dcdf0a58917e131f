// SPDX-License-Identifier: MIT
// Searches for the best setting within a budget: the least error for at most so many milliseconds, or the least cost for
// at most so large an error.
//
// The free parameters of a technique span a cube in which each has its declared scale. First comes a coarse grid (or,
// of many parameters, points spread evenly), then from the best of them a pattern search (Hooke and Jeeves 1961): all
// neighbours at one step, along one axis and along two at once so that it can follow the bound, and half the step when
// none is better. What looks best in the end is measured again, for longer and side by side, and only that is proposed.
#pragma once

#include "renderer/measure/combinations.h"
#include "renderer/measure/measurement.h"

#include <functional>
#include <limits>
#include <optional>
#include <span>

namespace penumbra {

enum class Bound { Cost, Error };

struct Budget {
    Bound bound = Bound::Cost;
    double limit = 0; // of the cost [ms] or of the RMSE over all pixels
};

// A parameter that the search may turn: of one technique ("pcss.filter-taps") or of all that have it.
struct FreeParameter {
    std::string name;
    std::optional<double> from, to; // else its whole range
};
// "NAME,NAME=FROM:TO,...". Throws InputError.
std::vector<FreeParameter> parseFree(std::string_view text);

// What was found out of a setting. NaN: it is not known, for the reason given.
struct Outcome {
    double cost = std::numeric_limits<double>::quiet_NaN(); // median [ms]
    Interval interval;                                      // of the median
    double error = std::numeric_limits<double>::quiet_NaN();
    std::string trouble;

    double of(Bound bound) const { return bound == Bound::Cost ? cost : error; }
};

struct Trial {
    Setting setting; // its place is that among the trials
    Outcome outcome;
    bool careful = false; // measured for longer, beside others
};

// Finds out about settings, in their order; carefully: with more frames. Cancelled, it returns the first of them only.
using Evaluate = std::function<std::vector<Outcome>(std::span<const Trial> trials, bool carefully)>;

struct BudgetSearch {
    std::vector<Trial> trials;
    std::optional<size_t> proposal; // that keeps the budget; among the trials
    bool certain = true;            // the interval of its cost is within the budget as well
    bool complete = true;           // false: it was cancelled, and the proposal is the best so far
};

// Of a technique with free parameters, but for the last batch and the last comparison.
inline constexpr size_t mostTrials = 80;

// Refuses a free parameter that none of the techniques has, or that is out of its range. Returns how many trials a
// search is expected to take at most. Throws InputError.
size_t checkFree(std::span<const Setting> starts, std::span<const FreeParameter> free);
// `starts`: the techniques to be searched, each with the values of what is not free. A cancellation keeps what was
// tried. Throws as checkFree() does.
BudgetSearch searchBudget(std::span<const Setting> starts, std::span<const FreeParameter> free, const Budget& budget,
                          const Evaluate& evaluate);

// Evaluates in one or several views, of which the dearest gives the cost and the worst the error. `tried` is handed each
// result as it comes: of the dearest view, with the error figures of the worst one. `expected`: about how many trials.
Evaluate measuredIn(std::vector<Measurer>& views, size_t expected, std::function<void(SettingResult)> tried);

} // namespace penumbra
