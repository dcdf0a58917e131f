// SPDX-License-Identifier: MIT
#include "app/list.h"

#include "app/command_line.h"
#include "app/measurement_report.h"
#include "app/preset.h"
#include "renderer/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace penumbra {
namespace {

std::string_view typeName(Parameter::Type type) {
    static constexpr std::string_view names[] = {"real", "integer", "flag", "choice"};
    return names[static_cast<size_t>(type)];
}

// The passes of the session's frame, as they would be drawn.
Flow flowOf(const Session& session) {
    SceneState state;
    state.setScene(session.scene);
    state.update(session.clip, session.time, session.ground);
    Flow flow;
    flow.begin();
    buildFrame(flow, session, state, nullptr, nullptr, {.images = true});
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
        if (!channel.names.empty()) channels.back()["names"] = channel.names;
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

Json techniqueJson(const Technique& technique, const Card& card, const ParameterSet& parameterSet, const Flow& flow) {
    Json parameters = Json::array(), buffers = Json::array();
    for (const Parameter* parameter : parameterSet.all()) parameters.push_back(parameterJson(*parameter));
    for (const Flow::ImageNode& image : flow.images())
        if (image.repeat <= 1) buffers.push_back(bufferJson(flow, image)); // rounds of a repeat share their labels
    return {{"id", card.id},           {"title", card.title},          {"authors", card.authors},
            {"year", card.year},       {"venue", card.venue},          {"idea", card.idea},
            {"assumes", card.assumes}, {"fails", card.fails},          {"parameters", parameters},
            {"buffers", buffers},      {"reads", readsJson(technique)}};
}

// What a scene file offers to choose from.
Json sceneJson(const Scene& scene) {
    const auto names = [](const auto& list) {
        Json json = Json::array();
        for (const auto& element : list) json.push_back(element.name);
        return json;
    };
    Json clips = Json::array();
    for (const Animation& clip : scene.animations)
        clips.push_back(
            {{"name", clip.name}, {"seconds", std::round(1000.0 * static_cast<double>(clip.duration)) / 1000}});
    return {{"file", scene.file.string()},     {"description", scene.description}, {"triangles", scene.triangleCount()},
            {"parts", scene.sceneNames},       {"variants", scene.variantNames},   {"clips", clips},
            {"cameras", names(scene.cameras)}, {"lights", names(scene.lights)},    {"notes", scene.notes}};
}

Json builtInScenesJson() {
    Json json = Json::array();
    for (const std::string& name : builtInScenes())
        json.push_back({{"name", name}, {"description", importGltf(findScene(name)).description}});
    return json;
}

// Everything that there is to list; the text is written from it.
Json listing(const Options& options) {
    Shot shot;
    Session session = makeSession(options, shot);
    Json techniques = Json::array();
    for (const Card* card : catalogue()) {
        if (options.technique && card->id != *options.technique) continue;
        session.techniques.choose(card->id);
        techniques.push_back(
            techniqueJson(session.techniques.technique(), *card, session.techniques.parameters(), flowOf(session)));
    }
    Json json = {{"version", PENUMBRA_VERSION},
                 {"techniques", techniques},
                 {"scenes", builtInScenesJson()},
                 {"presets", presetNames()}};
    if (options.scene) json["scene"] = sceneJson(*session.scene);
    return json;
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
    if (const std::string reads = readsText(technique["reads"]); !reads.empty())
        fmt::print("  Reads: {} texels a pixel\n", reads);
    if (!technique["parameters"].empty()) fmt::print("  Parameters\n");
    for (const Json& parameter : technique["parameters"]) printParameter(id, parameter);
    fmt::print("  Buffers\n");
    for (const Json& buffer : technique["buffers"]) printBuffer(buffer);
    fmt::print("\n");
}

void printScene(const Json& scene) {
    fmt::print("{}: {} triangles\n", text(scene, "file"), scene["triangles"].get<uint64_t>());
    if (const std::string description = text(scene, "description"); !description.empty())
        fmt::print("  {}\n", description);
    for (const auto& [key, list] : scene.items()) {
        // Notes go to stderr, and a single part is no choice.
        if (!list.is_array() || list.empty() || key == "notes" || (key == "parts" && list.size() == 1)) continue;
        fmt::print("  {}{}:\n", char(std::toupper(key[0])), key.substr(1));
        for (const Json& entry : list) {
            if (entry.is_string())
                fmt::print("    {}\n", entry.get<std::string>());
            else
                fmt::print("    {} ({} s)\n", text(entry, "name"), entry["seconds"].get<double>());
        }
    }
    fmt::print("\n");
}

} // namespace

void list(const Options& options) {
    const Json json = listing(options);
    if (options.json) {
        fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
        return;
    }
    if (json.contains("scene")) printScene(json["scene"]);
    for (const Json& technique : json["techniques"]) printTechnique(technique);
    fmt::print("Scenes\n");
    for (const Json& scene : json["scenes"])
        fmt::print("  {:<24} {}\n", text(scene, "name"), text(scene, "description"));
    fmt::print("\nPresets\n");
    for (const Json& preset : json["presets"]) fmt::print("  {}\n", preset.get<std::string>());
}

} // namespace penumbra
