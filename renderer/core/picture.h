// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace penumbra {

struct Picture {
    int width = 0, height = 0;
    std::vector<std::string> channels; // names, such as "R", "G", "B"
    std::vector<float> values;         // width·height·channels, top row first
};

} // namespace penumbra
