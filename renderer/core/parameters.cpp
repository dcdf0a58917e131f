// SPDX-License-Identifier: MIT
#include "renderer/core/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>

namespace penumbra {

std::string_view unitName(Unit unit) {
    switch (unit) {
    case Unit::None: return "";
    case Unit::Metres: return "m";
    case Unit::Degrees: return "°";
    case Unit::Pixels: return "pixels";
    case Unit::Texels: return "texels";
    case Unit::Samples: return "samples";
    case Unit::Percent: return "%";
    case Unit::DepthRange: return "of depth range";
    case Unit::Slope: return "× slope";
    }
    return "";
}

namespace {

// "kernel-size" → "KERNEL_SIZE"
std::string upperCase(std::string_view kebab) {
    std::string name(kebab);
    for (char& c : name) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return name;
}

} // namespace

Parameter::Parameter(ParameterSet& set, Type type, const Spec& spec)
    : set_(set)
    , type_(type)
    , spec_(spec)
    , group_(set.group_) {
    if (type == Type::Choice) {
        spec_.min = 0;
        spec_.max = static_cast<double>(spec.choices.size()) - 1;
    }
    if (type == Type::Flag) {
        spec_.min = 0;
        spec_.max = 1;
    }
    if (type != Type::Real && spec_.step == 0) spec_.step = 1;
    ensure(!set.find(spec_.id), "two parameters of one set have the same id");
    set.all_.push_back(this);
}

std::string Parameter::label() const {
    if (!spec_.label.empty()) return std::string(spec_.label);
    std::string words(spec_.id);
    std::replace(words.begin(), words.end(), '-', ' ');
    words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
    return words;
}

std::string Parameter::qualifiedName() const {
    return set_.owner().empty() ? std::string(spec_.id) : fmt::format("{}.{}", set_.owner(), spec_.id);
}

double Parameter::defaultValue() const { return spec_.defaultFrom ? spec_.defaultFrom(set_) : spec_.value; }

void Parameter::set(double value) {
    if (!std::isfinite(value) || value < spec_.min || value > spec_.max || onStep(value, spec_.max) != value)
        throw InputError(fmt::format("{}: {} is not in {}", qualifiedName(),
                                     type_ == Type::Real ? fmt::format("{:.9g}", value) : fmt::format("{:g}", value),
                                     rangeText()));
    value_ = value;
}

void Parameter::setText(std::string_view text) {
    const auto refuse = [&] {
        const std::string hint = type_ == Type::Choice ? suggestion(text, spec_.choices) : std::string();
        throw InputError(fmt::format("{}: '{}' is not in {}{}", qualifiedName(), text, rangeText(), hint));
    };
    if (type_ == Type::Choice) {
        const auto found = std::find(spec_.choices.begin(), spec_.choices.end(), text);
        if (found == spec_.choices.end()) refuse();
        return set(static_cast<double>(found - spec_.choices.begin()));
    }
    if (type_ == Type::Flag) {
        if (text == "true" || text == "on" || text == "1") return set(1);
        if (text == "false" || text == "off" || text == "0") return set(0);
        refuse();
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) refuse();
    set(value);
}

std::string Parameter::textOf(double value) const {
    switch (type_) {
    case Type::Choice: return std::string(spec_.choices[static_cast<size_t>(value)]);
    case Type::Flag: return value != 0 ? "true" : "false";
    case Type::Integer: return fmt::format("{}", static_cast<long long>(value));
    case Type::Real: return fmt::format("{}", value); // shortest text that reads back to the same number
    }
    return {};
}

std::string Parameter::rangeText() const {
    if (type_ == Type::Choice) return fmt::format("{}", fmt::join(spec_.choices, ", "));
    if (type_ == Type::Flag) return "true, false";
    std::string range = fmt::format("{:g}..{:g}", spec_.min, spec_.max);
    const std::string_view unit = unitName(spec_.unit);
    if (!unit.empty()) range += fmt::format("{}{}", spec_.unit == Unit::Degrees ? "" : " ", unit);
    if (type_ == Type::Integer && spec_.step == 2)
        range += std::fmod(spec_.min, 2) == 1 ? ", odd" : ", even";
    else if (spec_.step > 1 || (type_ == Type::Real && spec_.step > 0))
        range += fmt::format(" in steps of {:g}", spec_.step);
    return range;
}

double Parameter::limit() const { return spec_.limitFrom ? std::min(spec_.limitFrom(set_), spec_.max) : spec_.max; }

double Parameter::onStep(double value, double max) const {
    value = std::clamp(value, spec_.min, max);
    if (spec_.step > 0) {
        value = spec_.min + std::round((value - spec_.min) / spec_.step) * spec_.step;
        if (value > max) value -= spec_.step;
    }
    return value;
}

double Parameter::nearest(double value) const { return std::isnan(value) ? defaultValue() : onStep(value, limit()); }

uint32_t Parameter::bits() const {
    if (type_ == Type::Real) return std::bit_cast<uint32_t>(static_cast<float>(value()));
    return std::bit_cast<uint32_t>(static_cast<int32_t>(value()));
}

Parameter* ParameterSet::find(std::string_view id) const {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const Parameter* p) { return p->spec().id == id; });
    return found == all_.end() ? nullptr : *found;
}

Parameter& ParameterSet::at(std::string_view id) const {
    if (Parameter* found = find(id)) return *found;
    std::vector<std::string_view> names;
    for (const Parameter* p : all_) names.push_back(p->spec().id);
    throw InputError(
        fmt::format("{} has no parameter '{}'{}", owner_.empty() ? "this set" : owner_, id, suggestion(id, names)));
}

void ParameterSet::refuseBeyondLimits() const {
    for (const Parameter* p : all_)
        if (p->value() > p->limit())
            throw InputError(fmt::format("{}: {} is beyond its limit of {:g}, {}", p->qualifiedName(), p->text(),
                                         p->limit(), p->spec().limitReason));
}

void ParameterSet::reset() {
    for (Parameter* p : all_) p->reset();
}

void ParameterSet::copyValuesFrom(const ParameterSet& other) {
    ensure(all_.size() == other.all_.size(), "parameter sets of different declarations");
    for (size_t i = 0; i < all_.size(); ++i) all_[i]->value_ = other.all_[i]->value_;
}

bool ParameterSet::operator==(const ParameterSet& other) const {
    return owner_ == other.owner_ &&
           std::equal(all_.begin(), all_.end(), other.all_.begin(), other.all_.end(),
                      [](const Parameter* a, const Parameter* b) { return a->bits() == b->bits(); });
}

std::string camelCase(std::string_view kebab) {
    std::string name;
    bool upper = false;
    for (const char c : kebab) {
        if (c == '-') {
            upper = true;
            continue;
        }
        name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        upper = false;
    }
    return name;
}

std::string glslBlock(const ParameterSet& set) {
    std::string constants, members;
    for (const Parameter* p : set.all()) {
        const std::string name = upperCase(p->spec().id);
        for (size_t i = 0; i < p->spec().choices.size(); ++i)
            constants += fmt::format("#define {}_{} {}\n", name, upperCase(p->spec().choices[i]), i);
        if (p->spec().programConstant)
            constants += fmt::format("#define {} {}\n", name,
                                     p->type() == Parameter::Type::Real ? p->text() : fmt::format("{:g}", p->value()));
        else
            members += fmt::format("    {} {};\n", p->type() == Parameter::Type::Real ? "float" : "int",
                                   camelCase(p->spec().id));
    }
    if (!members.empty()) members = "layout(std140, binding = 1) uniform Parameters {\n" + members + "};\n";
    return constants + members;
}

void packBlock(const ParameterSet& set, std::vector<uint32_t>& out) {
    out.clear();
    for (const Parameter* p : set.all())
        if (!p->spec().programConstant) out.push_back(p->bits());
}

} // namespace penumbra
