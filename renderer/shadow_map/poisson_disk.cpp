// SPDX-License-Identifier: MIT
#include "renderer/shadow_map/poisson_disk.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <random>
#include <vector>

namespace penumbra {

using glm::vec2;

std::span<const vec2> poissonDisk(int n) {
    static std::mutex mutex; // a window draws while another thread measures; a set that is there stays as it is
    const std::lock_guard lock(mutex);
    static std::map<int, std::vector<vec2>> sets;
    std::vector<vec2>& set = sets[n];
    std::mt19937 random(12345);
    const auto uniform = [&] { return 2 * static_cast<float>(random()) / 4294967296.0f - 1; };
    while (set.size() < static_cast<size_t>(n)) {
        vec2 best{};
        float farthest = -1;
        for (int candidate = 0; candidate < 64 * n; ++candidate) {
            const vec2 p{uniform(), uniform()};
            if (glm::dot(p, p) > 1) continue;
            float nearest = 8;
            for (const vec2 q : set) nearest = std::min(nearest, glm::distance(p, q));
            if (nearest > farthest) farthest = nearest, best = p;
        }
        set.push_back(best);
    }
    return set;
}

} // namespace penumbra
