// SPDX-License-Identifier: MIT
#include "app/settings.h"

#include "app/file_io.h"
#include "app/json_text.h"
#include "renderer/core/error.h"
#include "renderer/core/paths.h"

#include <fmt/format.h>

#include <cstdlib>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

constexpr size_t largestFile = 1 << 20; // bytes

fs::path settingsFile() {
    const fs::path folder = configFolder();
    return folder.empty() ? folder : folder / "settings.json";
}

} // namespace

Settings defaultSettings() {
    const char* home = std::getenv("HOME");
    const fs::path pictures = fs::path(home ? home : "") / "Pictures";
    std::error_code ignored;
    return {fs::is_directory(pictures, ignored) ? pictures : fs::current_path(ignored)};
}

Settings loadSettings() {
    Settings settings = defaultSettings();
    const fs::path file = settingsFile();
    std::error_code ignored;
    if (file.empty() || !fs::exists(file, ignored)) return settings;
    Json json;
    try {
        json = parseJson(readFile(file, largestFile));
    } catch (const InputError& error) {
        const std::string message = error.what();
        throw InputError(message.starts_with(file.string()) ? message : file.string() + ": " + message);
    }
    if (!json.is_object()) throw InputError(fmt::format("{}: an object was expected", file.string()));
    const Json* pictures = findKey(json, "pictures");
    if (!pictures) return settings;
    if (!pictures->is_string() || !fs::path(pictures->get<std::string>()).is_absolute())
        throw InputError(fmt::format("{}: 'pictures': the absolute path of a folder was expected, not {}",
                                     file.string(), briefText(*pictures)));
    settings.pictures = pictures->get<std::string>();
    return settings;
}

void saveSettings(const Settings& settings) {
    const fs::path file = settingsFile();
    if (file.empty()) throw InputError("settings have no folder: neither HOME nor XDG_CONFIG_HOME is set");
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) throw InputError(fmt::format("{}: cannot be made: {}", file.parent_path().string(), error.message()));
    writeFileAtomically(file, Json{{"pictures", settings.pictures.string()}}.dump(2) + "\n");
}

} // namespace penumbra
