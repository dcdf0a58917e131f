// SPDX-License-Identifier: MIT
#include "app/preset.h"

#include "app/file_io.h"
#include "renderer/core/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

constexpr size_t largestPreset = 1 << 20; // bytes

std::string_view typeName(Parameter::Type type) {
    switch (type) {
    case Parameter::Type::Real: return "a number";
    case Parameter::Type::Integer: return "a whole number";
    case Parameter::Type::Flag: return "true or false";
    case Parameter::Type::Choice: return "a name";
    }
    return "";
}

bool hasType(const Json& value, Parameter::Type type) {
    switch (type) {
    case Parameter::Type::Real:
    case Parameter::Type::Integer: return value.is_number();
    case Parameter::Type::Flag: return value.is_boolean();
    case Parameter::Type::Choice: return value.is_string();
    }
    return false;
}

void setFromJson(Parameter& parameter, const Json& value) {
    if (!hasType(value, parameter.type()))
        throw InputError(fmt::format("{}: {} was expected ({}), not {}", parameter.qualifiedName(),
                                     typeName(parameter.type()), parameter.rangeText(), value.type_name()));
    if (value.is_number())
        parameter.set(value.get<double>());
    else if (value.is_boolean())
        parameter.set(value.get<bool>() ? 1 : 0);
    else
        parameter.setText(value.get_ref<const std::string&>());
}

// The preset's technique, with the preset's values.
std::unique_ptr<Technique> readPreset(const Json& json) {
    if (!json.is_object()) throw InputError(fmt::format("an object was expected, not {}", json.type_name()));
    static constexpr std::string_view keys[] = {"technique", "parameters"};
    for (const auto& [key, value] : json.items())
        if (std::find(std::begin(keys), std::end(keys), key) == std::end(keys))
            throw InputError(fmt::format("unknown key '{}'{}", key, suggestion(key, keys)));
    return techniqueFromJson(findKey(json, "technique"), findKey(json, "parameters"));
}

fs::path userFolder() {
    const fs::path folder = configFolder();
    return folder.empty() ? folder : folder / "presets";
}

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    for (const Card* card : catalogue()) {
        const auto first = static_cast<std::ptrdiff_t>(names.size());
        std::error_code ignored;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder / card->id, ignored))
            if (entry.path().extension() == ".json")
                names.push_back(fmt::format("{}/{}", card->id, entry.path().stem().string()));
        std::sort(names.begin() + first, names.end());
    }
    return names;
}

// Throws InputError if the user has no such preset.
fs::path ownPreset(std::string_view technique, std::string_view name) {
    fs::path file = userPresetFile(technique, name);
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored))
        throw InputError(fmt::format("{}: there is no preset '{}' of yours", file.string(), name));
    return file;
}

} // namespace

Json jsonOf(const Parameter& parameter, double value) {
    switch (parameter.type()) {
    case Parameter::Type::Real: return value;
    case Parameter::Type::Integer: return static_cast<long long>(value);
    case Parameter::Type::Flag: return value != 0;
    case Parameter::Type::Choice: return parameter.textOf(value);
    }
    return nullptr;
}

Json parametersJson(const ParameterSet& set, Which which) {
    Json parameters = Json::object();
    for (const Parameter* parameter : set.all())
        if (which == Which::All || parameter->changed())
            parameters[std::string(parameter->spec().id)] = jsonOf(*parameter, parameter->value());
    return parameters;
}

std::unique_ptr<Technique> techniqueFromJson(const Json* id, const Json* parameters) {
    if (!id || !id->is_string()) throw InputError("'technique': the id of a technique was expected");
    auto technique = makeTechnique(findCard(id->get_ref<const std::string&>()));
    if (!parameters) return technique;
    if (!parameters->is_object())
        throw InputError(fmt::format("'parameters': an object was expected, not {}", parameters->type_name()));
    for (const auto& [key, value] : parameters->items()) setFromJson(technique->parameters().at(key), value);
    return technique;
}

Json presetOf(const TechniqueShelf& techniques) {
    return {{"technique", techniques.card().id},
            {"parameters", parametersJson(techniques.parameters(), Which::Changed)}};
}

void loadPreset(const fs::path& file, TechniqueShelf& techniques) {
    try {
        techniques.take(readPreset(parseJson(readFile(file, largestPreset)))->parameters());
    } catch (const InputError& error) {
        const std::string message = error.what();
        throw InputError(message.starts_with(file.string()) ? message : file.string() + ": " + message);
    }
}

void savePreset(const fs::path& file, const TechniqueShelf& techniques) {
    const fs::path folder = file.parent_path();
    if (std::error_code error; !folder.empty() && !fs::is_directory(folder, error)) {
        fs::create_directories(folder, error);
        if (error) throw InputError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
    }
    writeFileAtomically(file, presetOf(techniques).dump(2) + "\n");
}

std::vector<std::string> ownPresetNames() {
    const fs::path own = userFolder();
    return own.empty() ? std::vector<std::string>() : namesIn(own);
}

std::vector<std::string> builtInPresetNames() { return namesIn(assetFolder() / "presets"); }

std::vector<std::string> presetNames() {
    std::vector<std::string> names = ownPresetNames();
    for (std::string& name : builtInPresetNames())
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    return names;
}

fs::path findPreset(std::string_view nameOrFile) {
    std::error_code ignored;
    if (const fs::path file(nameOrFile); fs::exists(file, ignored)) return file;
    const std::vector<std::string> names = presetNames();
    if (std::find(names.begin(), names.end(), nameOrFile) == names.end()) {
        const std::vector<std::string_view> views(names.begin(), names.end());
        throw InputError(fmt::format("there is no preset or file '{}'{}", nameOrFile, suggestion(nameOrFile, views)));
    }
    const fs::path relative = std::string(nameOrFile) + ".json";
    const fs::path own = userFolder();
    return !own.empty() && fs::exists(own / relative, ignored) ? own / relative : assetFolder() / "presets" / relative;
}

fs::path userPresetFile(std::string_view technique, std::string_view name) {
    const fs::path folder = userFolder();
    if (folder.empty()) throw InputError("presets have no folder: neither HOME nor XDG_CONFIG_HOME is set");
    const auto allowed = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) ||
               std::string_view("-_. ").find(c) != std::string_view::npos;
    };
    if (name.empty() || name.size() > 100 || name[0] == '.' || name[0] == ' ' ||
        !std::all_of(name.begin(), name.end(), allowed))
        throw InputError(fmt::format("'{}' cannot be the name of a preset; letters, digits, '-', '_', '.' and blanks "
                                     "were expected, starting with neither '.' nor a blank",
                                     name));
    return folder / technique / (std::string(name) + ".json");
}

void renamePreset(std::string_view technique, std::string_view name, std::string_view newName) {
    const fs::path from = ownPreset(technique, name), to = userPresetFile(technique, newName);
    std::error_code error;
    if (fs::exists(to, error))
        throw InputError(fmt::format("{}: there is a preset '{}' already", to.string(), newName));
    fs::rename(from, to, error);
    if (error) throw InputError(fmt::format("{}: cannot be renamed: {}", from.string(), error.message()));
}

void deletePreset(std::string_view technique, std::string_view name) {
    const fs::path file = ownPreset(technique, name);
    std::error_code error;
    fs::remove(file, error);
    if (error) throw InputError(fmt::format("{}: cannot be deleted: {}", file.string(), error.message()));
}

} // namespace penumbra
