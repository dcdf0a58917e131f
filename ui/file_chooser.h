// SPDX-License-Identifier: MIT
// A dialog over the folders of this machine that picks one scene file, or a folder.
#pragma once

#include "ui/widgets.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace penumbra {

class FileChooser {
public:
    enum class Pick { Scene, Folder };
    explicit FileChooser(Pick pick = Pick::Scene) : pick_(pick) {}

    // Opens in this folder, or in the current one if it is empty.
    void open(const std::filesystem::path& folder);
    // Draws the dialog while it is open; the file or folder once it is chosen.
    std::optional<std::filesystem::path> draw(bool cancelled);

private:
    struct Entry {
        std::string name;
        bool folder;
    };
    void enter(const std::filesystem::path& folder);

    Pick pick_;
    bool opening_ = false;
    std::filesystem::path folder_;
    std::vector<Entry> entries_;
    std::string trouble_;
    TextField<4096> typed_;
};

} // namespace penumbra
