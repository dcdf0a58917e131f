// SPDX-License-Identifier: MIT
#include "renderer/core/paths.h"

#include "renderer/core/error.h"

#include <cstdlib>
#include <string_view>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

fs::path findDataFolder() {
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none);
    const fs::path installed = program.parent_path().parent_path() / "share" / "penumbra";
    for (const fs::path& folder : {installed, fs::path(PENUMBRA_SOURCE_FOLDER)})
        if (fs::is_directory(folder / "shaders", none)) return folder;
    throw InputError("the folder 'shaders' was expected in " + installed.string() + "; the installation is incomplete");
}

const fs::path& dataFolder() {
    static const fs::path folder = findDataFolder();
    return folder;
}

// The value of an environment variable that names a folder; relative ones count as not set (XDG base directories).
fs::path folderFromEnvironment(const char* name) {
    const char* value = std::getenv(name);
    const fs::path folder = value ? value : "";
    return folder.is_absolute() ? folder : fs::path();
}

// XDG base directories, but for a variable of our own.
fs::path ownFolder(const char* ours, const char* xdg, const char* belowHome) {
    if (const fs::path own = folderFromEnvironment(ours); !own.empty()) return own;
    if (const fs::path shared = folderFromEnvironment(xdg); !shared.empty()) return shared / "penumbra";
    const fs::path home = folderFromEnvironment("HOME");
    return home.empty() ? fs::path() : home / belowHome / "penumbra";
}

} // namespace

const fs::path& shaderFolder() {
    static const fs::path folder = dataFolder() / "shaders";
    return folder;
}

const fs::path& assetFolder() {
    static const fs::path folder = dataFolder() / "assets";
    return folder;
}

fs::path configFolder() { return ownFolder("PENUMBRA_CONFIG_DIR", "XDG_CONFIG_HOME", ".config"); }

fs::path cacheFolder() { return ownFolder("PENUMBRA_CACHE_DIR", "XDG_CACHE_HOME", ".cache"); }

} // namespace penumbra
