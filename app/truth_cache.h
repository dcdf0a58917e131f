// SPDX-License-Identifier: MIT
// Truths kept on disk, so that the same question is answered at once the next time.
#pragma once

#include "renderer/truth/truth.h"

#include <filesystem>

namespace penumbra {

class TruthFiles final : public TruthCache {
public:
    // Below this folder, `limit` bytes at most: the files that were used longest ago go first. A folder that cannot be
    // written keeps nothing, a damaged file counts as none; neither is an error.
    explicit TruthFiles(std::filesystem::path folder = defaultFolder(), uint64_t limit = uint64_t{512} << 20)
        : folder_(std::move(folder))
        , limit_(limit) {}
    std::optional<Truth> find(uint64_t hash) override;
    void keep(const Truth& truth) override;

    static std::filesystem::path defaultFolder(); // `truth` in cacheFolder(); empty: nothing is kept
    std::filesystem::path fileOf(uint64_t hash) const;

private:
    void makeRoom(uint64_t bytes) const;

    std::filesystem::path folder_;
    uint64_t limit_;
};

} // namespace penumbra
