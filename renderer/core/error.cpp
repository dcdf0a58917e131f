// SPDX-License-Identifier: MIT
#include "renderer/core/error.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace penumbra {
namespace {

// Insertions, deletions, replacements and swaps of neighbours (optimal string alignment), row by row.
size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
        std::swap(beforeLast, last);
        std::swap(last, row);
    }
    return last.back();
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
