// SPDX-License-Identifier: MIT
#include "renderer/measure/combinations.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra {
namespace {

// A name of a parameter, with or without its technique.
struct Name {
    std::string_view technique, parameter;
};

Name parseName(std::string_view text) {
    const size_t dot = text.find('.');
    return dot == std::string_view::npos ? Name{{}, text} : Name{text.substr(0, dot), text.substr(dot + 1)};
}

double number(std::string_view text, std::string_view whole) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError(fmt::format("--sweep: '{}' of '{}' is not a number", text, whole));
    return value;
}

std::vector<std::string> valuesOf(const SweepAxis& axis, Parameter& parameter) {
    if (axis.steps == 0) return axis.values;
    for (const double end : {axis.from, axis.to}) { // refused with the range if it is out of it
        const Spec& spec = parameter.spec();
        if (!(end >= spec.min && end <= spec.max)) parameter.set(end);
    }
    std::vector<std::string> values;
    for (int i = 0; i < axis.steps; ++i) {
        const double share = axis.steps > 1 ? static_cast<double>(i) / (axis.steps - 1) : 0;
        const double wanted = i == axis.steps - 1 && i > 0 ? axis.to
                              : axis.logarithmic           ? axis.from * std::pow(axis.to / axis.from, share)
                                                           : axis.from + share * (axis.to - axis.from);
        // Numbers that people can read; a float holds no more.
        const double readable = number(fmt::format("{:.7g}", wanted), axis.name);
        const std::string text = parameter.textOf(parameter.nearest(readable));
        if (values.empty() || values.back() != text) values.push_back(text);
    }
    return values;
}

std::vector<std::string> pieces(std::string_view text, char separator) {
    std::vector<std::string> found;
    for (size_t end; (end = text.find(separator)) != std::string_view::npos; text.remove_prefix(end + 1))
        found.emplace_back(text.substr(0, end));
    found.emplace_back(text);
    return found;
}

} // namespace

Setting::Setting(const Card& of, const ParameterSet& values) : Setting(of) {
    parameters().copyValuesFrom(values);
    for (const Parameter* parameter : parameters().all())
        if (parameter->changed()) named.push_back(parameter->spec().id);
}

Setting Setting::copy() const {
    Setting result(*card);
    result.parameters().copyValuesFrom(parameters());
    result.named = named;
    return result;
}

bool Setting::tells(const Parameter& parameter) const {
    return parameter.changed() || std::find(named.begin(), named.end(), parameter.spec().id) != named.end();
}

void Setting::set(Parameter& parameter, std::string_view text) {
    parameter.setText(text);
    if (std::find(named.begin(), named.end(), parameter.spec().id) == named.end()) named.push_back(parameter.spec().id);
}

std::string Setting::text() const {
    std::string text;
    for (const Parameter* parameter : parameters().all())
        if (tells(*parameter))
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", parameter->spec().id, parameter->text());
    return text;
}

Parameter* findParameter(const Setting& setting, std::string_view text) {
    const Name name = parseName(text);
    return name.technique.empty() || name.technique == setting.card->id ? setting.parameters().find(name.parameter)
                                                                        : nullptr;
}

void requireParameter(std::span<const Setting> settings, std::string_view text) {
    const Name name = parseName(text);
    if (!name.technique.empty()) {
        const auto technique = makeTechnique(findCard(name.technique));
        technique->parameters().at(name.parameter);
        return;
    }
    std::vector<std::string_view> known, techniques;
    for (const Setting& setting : settings) {
        for (const Parameter* parameter : setting.parameters().all()) known.push_back(parameter->spec().id);
        if (techniques.empty() || techniques.back() != setting.card->id) techniques.push_back(setting.card->id);
    }
    if (std::find(known.begin(), known.end(), name.parameter) == known.end())
        throw InputError(fmt::format("{} {} no parameter '{}'{}", fmt::join(techniques, ", "),
                                     techniques.size() == 1 ? "has" : "have", name.parameter,
                                     suggestion(name.parameter, known)));
}

void assign(std::vector<Setting>& settings, std::string_view assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string_view::npos)
        throw InputError(fmt::format("'{}' is not NAME=VALUE, such as kernel=9", assignment));
    const std::string_view name = assignment.substr(0, equals);
    requireParameter(settings, name);
    for (Setting& setting : settings)
        if (Parameter* parameter = findParameter(setting, name)) setting.set(*parameter, assignment.substr(equals + 1));
}

SweepAxis parseSweep(std::string_view text) {
    static constexpr std::string_view form = "NAME=FROM:TO:STEPS, NAME=FROM:TO:STEPS:log or NAME=V1,V2,V3";
    const size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
        throw InputError(fmt::format("--sweep: '{}' is not {}", text, form));
    SweepAxis axis;
    axis.name = text.substr(0, equals);
    const std::string_view values = text.substr(equals + 1);
    if (values.find(':') == std::string_view::npos) {
        axis.values = pieces(values, ',');
        return axis;
    }
    const std::vector<std::string> parts = pieces(values, ':');
    if (parts.size() < 3 || parts.size() > 4 || (parts.size() == 4 && parts[3] != "log"))
        throw InputError(fmt::format("--sweep: '{}' is not {}", text, form));
    axis.from = number(parts[0], text);
    axis.to = number(parts[1], text);
    const double steps = number(parts[2], text);
    if (!(steps >= 1 && steps <= mostSweepSteps) || steps != std::floor(steps))
        throw InputError(fmt::format("--sweep: STEPS of '{}' is not a whole number in 1..{}", text, mostSweepSteps));
    axis.steps = static_cast<int>(steps);
    axis.logarithmic = parts.size() == 4;
    if (axis.logarithmic && !(axis.from > 0 && axis.to > 0))
        throw InputError(fmt::format("--sweep: '{}' is logarithmic, so FROM and TO must be above 0", text));
    return axis;
}

std::vector<Setting> combine(std::vector<Setting> settings, const std::vector<SweepAxis>& axes) {
    for (const SweepAxis& axis : axes) {
        requireParameter(settings, axis.name);
        std::vector<Setting> more;
        bool used = false;
        for (Setting& setting : settings) {
            Parameter* parameter = findParameter(setting, axis.name);
            if (!parameter) {
                more.push_back(std::move(setting));
                continue;
            }
            used = true;
            const std::vector<std::string> values = valuesOf(axis, *parameter);
            if (more.size() + values.size() > mostCombinations)
                throw InputError(fmt::format("--sweep: more than {} combinations", mostCombinations));
            for (const std::string& value : values) {
                more.push_back(setting.copy());
                more.back().set(more.back().parameters().at(parameter->spec().id), value);
            }
        }
        if (!used) throw InputError(fmt::format("--sweep: '{}' is of no technique that is measured", axis.name));
        settings = std::move(more);
    }
    for (size_t i = 0; i < settings.size(); ++i) settings[i].place = i;
    return settings;
}

} // namespace penumbra
