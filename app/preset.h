// SPDX-License-Identifier: MIT
// Presets: {"technique": ID, "parameters": {ID: VALUE ...}} with what differs from the defaults.
#pragma once

#include "renderer/session.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// A value of a parameter as JSON: a number, true or false, or the name of a choice.
nlohmann::ordered_json jsonOf(const Parameter& parameter, double value);

// The chosen technique and its parameters that differ from their defaults.
nlohmann::ordered_json presetOf(const TechniqueShelf& techniques);

// Chooses the preset's technique and gives its parameters the preset's values, the others their defaults. Throws
// InputError that names file and key, and has changed nothing then.
void loadPreset(const std::filesystem::path& file, TechniqueShelf& techniques);
void savePreset(const std::filesystem::path& file, const TechniqueShelf& techniques);

// Presets by name, TECHNIQUE/NAME: the user's own (in the folder below), then those that come with the program.
std::vector<std::string> presetNames();
// A name or a file. Throws InputError that names the nearest preset.
std::filesystem::path findPreset(std::string_view nameOrFile);
// Where the user's preset NAME of the chosen technique is or would be: TECHNIQUE/NAME.json in the configuration folder.
// Throws InputError if the name has other than letters, digits, '-', '_', '.' and blanks or starts with '.' or a blank.
std::filesystem::path userPresetFile(const TechniqueShelf& techniques, std::string_view name);

} // namespace penumbra
