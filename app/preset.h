// SPDX-License-Identifier: MIT
// Presets: {"technique": ID, "parameters": {ID: VALUE ...}} with what differs from the defaults.
#pragma once

#include "app/json_text.h"
#include "renderer/session.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// A value of a parameter as JSON: a number, true or false, or the name of a choice.
Json jsonOf(const Parameter& parameter, double value);

enum class Which { Changed, All };
// Values by id; only those that differ from their defaults, or all.
Json parametersJson(const ParameterSet& set, Which which);

// The technique with these values, the others at their defaults; null: not there. Throws InputError that names what is
// unknown or out of range, and what is near.
std::unique_ptr<Technique> techniqueFromJson(const Json* id, const Json* parameters);

// The chosen technique and its parameters that differ from their defaults.
Json presetOf(const TechniqueShelf& techniques);

// Chooses the preset's technique and gives its parameters the preset's values, the others their defaults. Throws
// InputError that names file and key, and has changed nothing then.
void loadPreset(const std::filesystem::path& file, TechniqueShelf& techniques);
void savePreset(const std::filesystem::path& file, const TechniqueShelf& techniques);

// Presets by name, TECHNIQUE/NAME, in the order of the catalogue: the user's own (in the folder below) and those that
// come with the program; or both, without the built-in ones that an own one hides.
std::vector<std::string> ownPresetNames();
std::vector<std::string> builtInPresetNames();
std::vector<std::string> presetNames();
// A name or a file. Throws InputError that names the nearest preset.
std::filesystem::path findPreset(std::string_view nameOrFile);
// Where the user's preset NAME of a technique is or would be: TECHNIQUE/NAME.json in the configuration folder. Throws
// InputError if the name has other than letters, digits, '-', '_', '.' and blanks or starts with '.' or a blank.
std::filesystem::path userPresetFile(std::string_view technique, std::string_view name);

// For the user's own presets of a technique. Throw InputError, and have changed nothing then: there is none of this
// name, or there is one of the new name already.
void renamePreset(std::string_view technique, std::string_view name, std::string_view newName);
void deletePreset(std::string_view technique, std::string_view name);

} // namespace penumbra
