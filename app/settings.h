// SPDX-License-Identifier: MIT
// What the program keeps from one window to the next: settings.json in the configuration folder.
#pragma once

#include <filesystem>

namespace penumbra {

struct Settings {
    std::filesystem::path pictures; // folder of pictures and tables that the window saves; absolute
};

// Where nothing is kept, pictures go into Pictures in the home folder, or without one into the current folder. Throws
// InputError if the file is damaged.
Settings loadSettings();
Settings defaultSettings();
// Throws InputError.
void saveSettings(const Settings& settings);

} // namespace penumbra
