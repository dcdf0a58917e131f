// SPDX-License-Identifier: MIT
#include "renderer/core/error.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace penumbra {
namespace {

// Levenshtein distance, two rows at a time.
size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row.back();
}

} // namespace

std::string_view nearestName(std::string_view name, std::span<const std::string_view> names) {
    std::string_view best;
    size_t least = name.size() / 2 + 1;
    for (const std::string_view candidate : names) {
        const size_t distance = editDistance(name, candidate);
        if (distance < least) {
            least = distance;
            best = candidate;
        }
    }
    return best;
}

std::string suggestion(std::string_view name, std::span<const std::string_view> names) {
    const std::string_view near = nearestName(name, names);
    return near.empty() ? std::string() : "; did you mean '" + std::string(near) + "'?";
}

} // namespace penumbra
