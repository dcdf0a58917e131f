// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace penumbra {

// The folders `shaders` and `assets`: beside the installed program (PREFIX/share/penumbra, found from where the program
// is, so that an installed tree may be moved), or else those of the source tree it was built from.
const std::filesystem::path& shaderFolder();
const std::filesystem::path& assetFolder();

// Where the user's own presets and the window's layout are kept: $PENUMBRA_CONFIG_DIR, or `penumbra` in
// $XDG_CONFIG_HOME or in ~/.config. It need not exist; empty if none of the variables is an absolute path.
std::filesystem::path configFolder();

// Where is kept what can be worked out again: $PENUMBRA_CACHE_DIR, or `penumbra` in $XDG_CACHE_HOME or in ~/.cache.
// As configFolder() otherwise.
std::filesystem::path cacheFolder();

} // namespace penumbra
