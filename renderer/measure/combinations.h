// SPDX-License-Identifier: MIT
// Which settings a measurement compares: techniques, with parameters that were set or are swept. No OpenGL.
#pragma once

#include "renderer/core/technique.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// A technique with values of its parameters: one row of a measurement.
struct Setting {
    const Card* card;
    std::unique_ptr<Technique> technique;
    std::vector<std::string_view> named; // ids of parameters that were set or swept, even to their defaults
    size_t place = 0;                    // among all combinations

    explicit Setting(const Card& of) : card(&of), technique(makeTechnique(of)) {}
    Setting(const Card& of, const ParameterSet& values); // what differs from the defaults counts as named
    Setting copy() const;
    ParameterSet& parameters() const { return technique->parameters(); }
    bool tells(const Parameter& parameter) const; // whether it is worth a word: named, or not at its default
    void set(Parameter& parameter, std::string_view text);
    // "kernel 9, shape box"
    std::string text() const;
};

// A parameter by name, "pcf.kernel" or "kernel"; null if the setting has none.
Parameter* findParameter(const Setting& setting, std::string_view name);
// Refuses one that no setting has, with the nearest one. Throws InputError.
void requireParameter(std::span<const Setting> settings, std::string_view name);

// "pcf.kernel=9", or "kernel=9" for every technique of the list that has a kernel. Throws InputError, also if none has.
void assign(std::vector<Setting>& settings, std::string_view assignment);

// One axis of a sweep: NAME=FROM:TO:STEPS[:log] or NAME=v1,v2,v3, with NAME as in an assignment.
struct SweepAxis {
    std::string name;
    std::vector<std::string> values; // of a list
    double from = 0, to = 0;         // of steps, both included
    int steps = 0;                   // 0: a list
    bool logarithmic = false;
};
inline constexpr int mostSweepSteps = 10000;
SweepAxis parseSweep(std::string_view text); // throws InputError

// Every setting with every combination of the values of those axes that it has; the last axis turns fastest. Steps that
// a parameter cannot take go to the nearest that it can, once. Throws InputError if no setting has an axis, or a value
// is out of range.
std::vector<Setting> combine(std::vector<Setting> settings, const std::vector<SweepAxis>& axes);
inline constexpr size_t mostCombinations = 100000;

} // namespace penumbra
