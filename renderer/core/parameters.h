// SPDX-License-Identifier: MIT
// One declaration per tunable. A technique declares its parameters as members of a ParameterSet; the slider, the
// command line flag, the JSON key, the sweep axis, the uniform and the row in the docs all follow from that one line.
//
//     struct Parameters : ParameterSet {
//         Real sigma{*this, {.id = "sigma", .symbol = "σ", .value = 2.4, .min = 0.1, .max = 32, .unit = Unit::Texels}};
//     };
#pragma once

#include "renderer/core/error.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

enum class Unit { None, Metres, Degrees, Pixels, Texels, Samples, Percent, DepthRange, Slope };

// As printed behind a value: "m", "°", "texels" ...; empty for Unit::None.
std::string_view unitName(Unit unit);

enum class Scale {
    Linear,
    Logarithmic, // a minimum of 0 is a separate lowest stop below the smallest positive value, `Spec::smallest`
};

class Parameter;
class ParameterSet;

// Everything the outside world knows about one tunable. Texts are literals; numbers are in `unit`.
struct Spec {
    std::string_view id;          // kebab-case, unique in its set; the GLSL member is its camelCase form
    std::string_view label = {};  // for people; empty: the id with spaces and a capital
    std::string_view symbol = {}; // as the paper writes it
    double value = 0;             // default; see also `defaultFrom`
    double min = 0, max = 1;      // inclusive
    double step = 0;              // values are min + k·step; 0: continuous (integers: 1)
    Unit unit = Unit::None;
    Scale scale = Scale::Linear;
    double smallest = 0;                            // logarithmic with min = 0: the smallest positive value
    bool programConstant = false;                   // compiled into the shader as a #define instead of a uniform
    std::string_view source = {};                   // paper and equation that it comes from
    std::string_view help = {};                     // one or two sentences: what it trades for what
    std::span<const std::string_view> choices = {}; // names of the values 0, 1, 2 ... of a Choice

    // A default that depends on other parameters (α by format); null: `value`.
    double (*defaultFrom)(const ParameterSet&) = nullptr;
    // The largest value that other parameters leave it (an exponent, by the format that holds its power); null: `max`.
    // It may be set beyond, since they may be set after it; a frame is then refused, and says why.
    double (*limitFrom)(const ParameterSet&) = nullptr;
    std::string_view limitReason = {};
    // Whether it has an effect at the moment, and what to say if not; null: always.
    bool (*active)(const ParameterSet&) = nullptr;
    std::string_view inactiveReason = {};
};

// A 4-byte scalar that somebody may turn. Owned by the struct that declares it; never copied or moved.
class Parameter {
public:
    enum class Type { Real, Integer, Flag, Choice };

    Parameter(ParameterSet& set, Type type, const Spec& spec);
    Parameter(const Parameter&) = delete;
    Parameter& operator=(const Parameter&) = delete;

    const Spec& spec() const { return spec_; }
    Type type() const { return type_; }
    std::string_view group() const { return group_; } // "" or the title of the shared stage it belongs to
    std::string label() const;
    std::string qualifiedName() const; // "pcf.kernel", as on the command line

    double value() const { return value_ ? *value_ : defaultValue(); }
    double defaultValue() const;
    bool changed() const { return value_ && *value_ != defaultValue(); }
    double limit() const; // the largest value that a frame may be drawn with
    bool active() const { return !spec_.active || spec_.active(set_); }

    // Throws InputError with name, value and range if `value` is not a number, out of range or off the step.
    void set(double value);
    // Accepts numbers, choice names, and true/false/on/off for flags. Throws InputError.
    void setText(std::string_view text);
    void reset() { value_.reset(); }

    std::string text() const { return textOf(value()); } // readable by setText
    std::string textOf(double value) const;
    std::string rangeText() const; // "1..63 texels, odd" or "box, gaussian, poisson"

    // The value nearest to `value` that set() accepts and a frame may be drawn with.
    double nearest(double value) const;
    // The 4 bytes of the uniform: float for Real, int for the others.
    uint32_t bits() const;

private:
    friend class ParameterSet;
    double onStep(double value, double max) const;
    ParameterSet& set_;
    Type type_;
    Spec spec_;
    std::string_view group_;
    std::optional<double> value_;
};

struct Real : Parameter {
    Real(ParameterSet& set, const Spec& spec) : Parameter(set, Type::Real, spec) {}
    operator float() const { return static_cast<float>(value()); }
};

struct Integer : Parameter {
    Integer(ParameterSet& set, const Spec& spec) : Parameter(set, Type::Integer, spec) {}
    operator int() const { return static_cast<int>(value()); }
};

struct Flag : Parameter {
    Flag(ParameterSet& set, const Spec& spec) : Parameter(set, Type::Flag, spec) {}
    operator bool() const { return value() != 0; }
};

// One of a fixed list of names; E is an enumeration whose values are 0, 1, 2 ... in the order of Spec::choices.
template <class E> struct Choice : Parameter {
    Choice(ParameterSet& set, const Spec& spec) : Parameter(set, Type::Choice, spec) {}
    operator E() const { return static_cast<E>(static_cast<int>(value())); }
};

// A list of parameters with an owner's name. Groups that belong to a shared stage (kernel, map size, bias) are structs
// of parameters built on the same set between beginGroup and endGroup; see ParameterGroup.
class ParameterSet {
public:
    ParameterSet() = default;
    ParameterSet(const ParameterSet&) = delete;
    ParameterSet& operator=(const ParameterSet&) = delete;

    std::string_view owner() const { return owner_; } // the technique's id; set by the catalogue
    void setOwner(std::string_view id) { owner_ = id; }

    std::span<Parameter* const> all() const { return all_; }
    Parameter* find(std::string_view id) const;
    // Throws InputError that names the nearest parameter.
    Parameter& at(std::string_view id) const;
    // Throws InputError that names a parameter which is beyond its limit.
    void refuseBeyondLimits() const;
    void reset();
    void copyValuesFrom(const ParameterSet& other);   // same declaration
    bool operator==(const ParameterSet& other) const; // same owner, same values

private:
    friend class Parameter;
    friend class ParameterGroup;
    std::string_view owner_;
    std::string_view group_; // of the parameters being declared
    std::vector<Parameter*> all_;
};

// Base of a struct of parameters that a shared stage declares and techniques include as a member:
//     struct KernelParameters : ParameterGroup {
//         explicit KernelParameters(ParameterSet& s) : ParameterGroup(s, "Kernel") {}
//         Integer size{set, {...}};
//         End end{set};
//     };
class ParameterGroup {
public:
    ParameterGroup(ParameterSet& set, std::string_view title) : set(set) { set.group_ = title; }
    ParameterSet& set;

    // Last member: the parameters declared after it belong to no group.
    struct End {
        explicit End(ParameterSet& set) { set.group_ = {}; }
    };
};

// "search-taps" → "searchTaps"
std::string camelCase(std::string_view kebab);

// What a technique's shaders see of its parameters, as GLSL text: the std140 block `float sigma; int kernel; ...` at
// offsets 4·i; `#define KERNEL_BOX 0` for each name of a choice; `#define KERNEL 1` for each program constant.
std::string glslBlock(const ParameterSet& set);
// The bytes of that block: one 4-byte scalar per parameter that is not a program constant.
void packBlock(const ParameterSet& set, std::vector<uint32_t>& out);

} // namespace penumbra
