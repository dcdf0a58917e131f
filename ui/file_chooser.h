// SPDX-License-Identifier: MIT
// A dialog over the folders of this machine that picks one scene file.
#pragma once

#include "ui/widgets.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace penumbra {

class FileChooser {
public:
    // Opens in this folder, or in the current one if it is empty.
    void open(const std::filesystem::path& folder);
    // Draws the dialog while it is open; the file once it is chosen.
    std::optional<std::filesystem::path> draw(bool cancelled);

private:
    struct Entry {
        std::string name;
        bool folder;
    };
    void enter(const std::filesystem::path& folder);

    bool opening_ = false;
    std::filesystem::path folder_;
    std::vector<Entry> entries_;
    std::string trouble_;
    TextField<4096> typed_;
};

} // namespace penumbra
