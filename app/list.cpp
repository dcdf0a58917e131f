// SPDX-License-Identifier: MIT
#include "app/list.h"

#include "app/command_line.h"
#include "app/preset.h"
#include "renderer/frame.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace penumbra {
namespace {

using Json = nlohmann::ordered_json;

std::string_view typeName(Parameter::Type type) {
    static constexpr std::string_view names[] = {"real", "integer", "flag", "choice"};
    return names[static_cast<size_t>(type)];
}

// The passes of the session's frame, as they would be drawn.
Flow flowOf(const Session& session) {
    SceneState state;
    state.setScene(session.scene);
    state.update(session.clip, session.time, session.ground);
    const glm::mat4 clipFromWorld = sessionView(session, state.bounds()).clipFromWorld;
    Flow flow;
    flow.begin();
    buildFrame(flow, session, state, nullptr, clipFromWorld);
    return flow;
}

Json parameterJson(const Parameter& parameter) {
    const Spec& spec = parameter.spec();
    const bool number = parameter.type() == Parameter::Type::Real || parameter.type() == Parameter::Type::Integer;
    Json json = {{"id", spec.id},
                 {"label", parameter.label()},
                 {"symbol", spec.symbol},
                 {"group", parameter.group()},
                 {"type", typeName(parameter.type())},
                 {"default", jsonOf(parameter, parameter.defaultValue())},
                 {"range", parameter.rangeText()},
                 {"unit", unitName(spec.unit)},
                 {"source", spec.source},
                 {"help", spec.help}};
    if (number) {
        json["min"] = spec.min;
        json["max"] = spec.max;
        json["step"] = spec.step;
        json["scale"] = spec.scale == Scale::Logarithmic ? "logarithmic" : "linear";
    }
    if (parameter.type() == Parameter::Type::Choice) json["choices"] = spec.choices;
    return json;
}

Json bufferJson(const Flow& flow, const Flow::ImageNode& image) {
    const ImageSpec& spec = image.spec;
    Json channels = Json::array();
    for (const Channel& channel : spec.channels) {
        channels.push_back({{"name", channel.name},
                            {"symbol", channel.symbol},
                            {"meaning", channel.meaning},
                            {"unit", unitName(channel.unit)}});
        if (channel.min < channel.max) channels.back()["range"] = {channel.min, channel.max};
    }
    return {{"label", flow.label(image.label)},
            {"stage", stageName(flow.passes()[static_cast<size_t>(image.pass)].stage)},
            {"format", info(spec.format).name},
            {"width", spec.extent.width},
            {"height", spec.extent.height},
            {"layers", spec.extent.layers},
            {"levels", spec.extent.levels},
            {"bytes", spec.bytes()},
            {"channels", channels}};
}

Json techniqueJson(const Card& card, const ParameterSet& parameterSet, const Flow& flow) {
    Json parameters = Json::array(), buffers = Json::array();
    for (const Parameter* parameter : parameterSet.all()) parameters.push_back(parameterJson(*parameter));
    for (const Flow::ImageNode& image : flow.images())
        if (image.repeat <= 1) buffers.push_back(bufferJson(flow, image)); // rounds of a repeat share their labels
    return {{"id", card.id},           {"title", card.title}, {"authors", card.authors},
            {"year", card.year},       {"venue", card.venue}, {"idea", card.idea},
            {"assumes", card.assumes}, {"fails", card.fails}, {"parameters", parameters},
            {"buffers", buffers}};
}

// Everything that there is to list; the text is written from it.
Json listing(const Options& options) {
    Session session = makeSession(options);
    Json techniques = Json::array();
    for (const Card* card : catalogue()) {
        if (options.technique && card->id != *options.technique) continue;
        session.techniques.choose(card->id);
        techniques.push_back(techniqueJson(*card, session.techniques.parameters(), flowOf(session)));
    }
    return {{"version", PENUMBRA_VERSION},
            {"techniques", techniques},
            {"scenes", builtInScenes()},
            {"presets", presetNames()}};
}

std::string text(const Json& json, const char* key) { return json[key].get<std::string>(); }

void printParameter(const std::string& owner, const Json& parameter) {
    const Json& value = parameter["default"];
    const std::string name = owner + "." + text(parameter, "id");
    fmt::print("    {:<32} {} (default {})\n", name, text(parameter, "range"),
               value.is_string() ? value.get<std::string>() : value.dump());
    if (const std::string help = text(parameter, "help"); !help.empty()) fmt::print("        {}\n", help);
}

void printBuffer(const Json& buffer) {
    std::string channels;
    for (const Json& channel : buffer["channels"]) {
        const std::string unit = text(channel, "unit");
        channels += fmt::format("{}{}{}", channels.empty() ? "" : ", ", text(channel, "name"),
                                unit.empty() ? "" : " [" + unit + "]");
    }
    fmt::print("    {:<32} {} {}x{}: {}\n", text(buffer, "label"), text(buffer, "format"), buffer["width"].get<int>(),
               buffer["height"].get<int>(), channels);
}

void printTechnique(const Json& technique) {
    const std::string id = text(technique, "id");
    fmt::print("{}: {}", id, text(technique, "title"));
    if (technique["year"] != 0)
        fmt::print(" ({}, {} {})", text(technique, "authors"), text(technique, "venue"), technique["year"].get<int>());
    fmt::print("\n  Idea: {}\n  Assumes: {}\n  Fails: {}\n", text(technique, "idea"), text(technique, "assumes"),
               text(technique, "fails"));
    if (!technique["parameters"].empty()) fmt::print("  Parameters\n");
    for (const Json& parameter : technique["parameters"]) printParameter(id, parameter);
    fmt::print("  Buffers\n");
    for (const Json& buffer : technique["buffers"]) printBuffer(buffer);
    fmt::print("\n");
}

void printNames(const char* title, const Json& names) {
    fmt::print("{}\n", title);
    for (const Json& name : names) fmt::print("  {}\n", name.get<std::string>());
}

} // namespace

void list(const Options& options) {
    const Json json = listing(options);
    if (options.json) {
        fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
        return;
    }
    for (const Json& technique : json["techniques"]) printTechnique(technique);
    printNames("Scenes", json["scenes"]);
    fmt::print("\n");
    printNames("Presets", json["presets"]);
}

} // namespace penumbra
