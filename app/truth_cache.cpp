// SPDX-License-Identifier: MIT
#include "app/truth_cache.h"

#include "app/file_io.h"
#include "renderer/core/error.h"
#include "renderer/core/paths.h"
#include "renderer/core/hash.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

constexpr size_t largestFile = size_t{1} << 31;

// The file: this header, then psi, standardError and classes, one after the other for all pixels.
struct Header {
    char magic[8] = {'P', 'S', 'I', 'T', 'R', 'U', 'E', '1'};
    uint64_t hash = 0;
    uint64_t checksum = 0; // of what follows this member
    int32_t width = 0, height = 0;
    int32_t samplesLeast = 0, samplesMost = 0, penumbraPixels = 0, unused = 0;
    double samplesMean = 0, meanPenumbraStandardError = 0, seconds = 0;
};
static_assert(sizeof(Header) == 72);
constexpr size_t checkedFrom = offsetof(Header, width);
constexpr size_t bytesPerPixel = 2 * sizeof(float) + sizeof(PixelClass);

uint64_t checksum(std::string_view bytes) {
    Hash hash;
    hash.addBytes(bytes.data() + checkedFrom, bytes.size() - checkedFrom);
    return hash.value();
}

} // namespace

fs::path TruthFiles::defaultFolder() {
    const fs::path cache = cacheFolder();
    return cache.empty() ? cache : cache / "truth";
}

fs::path TruthFiles::fileOf(uint64_t hash) const { return folder_ / fmt::format("{:016x}.truth", hash); }

std::optional<Truth> TruthFiles::find(uint64_t hash) {
    std::error_code ignored;
    const fs::path file = fileOf(hash);
    if (folder_.empty() || !fs::is_regular_file(file, ignored)) return std::nullopt;
    std::string bytes;
    try {
        const uint64_t size = fs::file_size(file, ignored);
        if (ignored || size < sizeof(Header) || size > largestFile) return std::nullopt;
        bytes = readFile(file, size);
    } catch (const InputError&) {
        return std::nullopt;
    }
    if (bytes.size() < sizeof(Header)) return std::nullopt;
    Header header;
    const Header expected;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (std::memcmp(header.magic, expected.magic, sizeof(header.magic)) != 0 || header.hash != hash ||
        header.width <= 0 || header.height <= 0 || header.checksum != checksum(bytes))
        return std::nullopt;
    const size_t pixels = static_cast<size_t>(header.width) * static_cast<size_t>(header.height);
    if (bytes.size() != sizeof(Header) + pixels * bytesPerPixel) return std::nullopt;

    Truth truth{.width = header.width,
                .height = header.height,
                .samplesLeast = header.samplesLeast,
                .samplesMost = header.samplesMost,
                .samplesMean = header.samplesMean,
                .meanPenumbraStandardError = header.meanPenumbraStandardError,
                .penumbraPixels = header.penumbraPixels,
                .complete = true,
                .fromCache = true,
                .seconds = header.seconds,
                .hash = hash};
    const char* from = bytes.data() + sizeof(Header);
    const auto take = [&](auto& list) {
        list.resize(pixels);
        std::memcpy(list.data(), from, pixels * sizeof(list[0]));
        from += pixels * sizeof(list[0]);
    };
    take(truth.psi), take(truth.standardError), take(truth.classes);
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored); // used now
    return truth;
}

void TruthFiles::keep(const Truth& truth) {
    if (folder_.empty()) return;
    Header header;
    header.hash = truth.hash;
    header.width = truth.width, header.height = truth.height;
    header.samplesLeast = truth.samplesLeast, header.samplesMost = truth.samplesMost;
    header.samplesMean = truth.samplesMean;
    header.penumbraPixels = truth.penumbraPixels;
    header.meanPenumbraStandardError = truth.meanPenumbraStandardError;
    header.seconds = truth.seconds;
    std::string bytes(sizeof(Header), '\0');
    const auto append = [&](const auto& list) {
        bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
    };
    append(truth.psi), append(truth.standardError), append(truth.classes);
    std::memcpy(bytes.data(), &header, sizeof(header));
    header.checksum = checksum(bytes);
    std::memcpy(bytes.data(), &header, sizeof(header));
    if (bytes.size() > std::min<uint64_t>(limit_, largestFile)) return;
    try {
        std::error_code ignored; // a folder that cannot be made shows when the file is written
        fs::create_directories(folder_, ignored);
        makeRoom(bytes.size());
        writeFileAtomically(fileOf(truth.hash), bytes);
    } catch (const InputError&) {
        // Where nothing can be kept, the next time costs as much as this one.
    }
}

void TruthFiles::makeRoom(uint64_t bytes) const {
    struct Kept {
        fs::file_time_type used;
        fs::path file;
        uint64_t size;
    };
    std::vector<Kept> all;
    std::error_code ignored;
    uint64_t sum = bytes;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, ignored)) {
        if (entry.path().extension() != ".truth" || !entry.is_regular_file(ignored)) continue;
        all.push_back({entry.last_write_time(ignored), entry.path(), entry.file_size(ignored)});
        sum += all.back().size;
    }
    std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    for (size_t i = 0; i < all.size() && sum > limit_; ++i) {
        fs::remove(all[i].file, ignored);
        sum -= all[i].size;
    }
}

} // namespace penumbra
