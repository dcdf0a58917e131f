// SPDX-License-Identifier: MIT
// The truth that is traced while the caller goes on, and the one that is kept on disk.
#include "app/truth_cache.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"
#include "tests/truth/closed_forms.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

using namespace penumbra;
using namespace penumbra::test;

namespace fs = std::filesystem;

namespace {

TruthInput inputOf(const Session& session) {
    renderer().reset();
    renderer().render(session);
    return readTruthInput(renderer(), session);
}

TruthInput sphereInput(glm::ivec2 size) { return inputOf(closedFormSession(closedForms[2], size)); }

template <class Done> bool waitUntil(Done&& done) {
    for (int i = 0; i < 6000; ++i) {
        if (done()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "penumbra-truth-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()));
        path_ = name;
    }
    ~TemporaryFolder() { fs::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

size_t filesIn(const fs::path& folder) {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

bool equal(const Truth& a, const Truth& b) {
    return a.width == b.width && a.height == b.height && a.psi == b.psi && a.standardError == b.standardError &&
           a.classes == b.classes && a.hash == b.hash && a.samplesLeast == b.samplesLeast &&
           a.samplesMost == b.samplesMost && a.samplesMean == b.samplesMean && a.penumbraPixels == b.penumbraPixels &&
           a.meanPenumbraStandardError == b.meanPenumbraStandardError;
}

} // namespace

TEST_CASE("the background gives first looks that improve, and in the end what waiting gives") {
    const TruthInput input = sphereInput({160, 120});
    TruthSettings settings{.leastSamples = 256, .mostSamples = 2048, .wantedStandardError = 0.003};
    const Truth expected = traceTruth(input, settings);
    settings.background = true;

    BackgroundTruth background;
    CHECK_FALSE(background.state().running);
    CHECK(background.latest() == nullptr);
    background.start(input, settings);
    CHECK(background.state().running);
    int looks = 0, samples = 0;
    std::shared_ptr<const Truth> last;
    double share = 0;
    const bool done = waitUntil([&] {
        const std::shared_ptr<const Truth> now = background.latest();
        if (now && now != last) {
            ++looks;
            CHECK(now->samplesMost >= samples);
            samples = now->samplesMost;
            last = now;
        }
        const BackgroundTruth::State state = background.state();
        CHECK((state.share >= 0 && state.share <= 1));
        share = std::max(share, state.share);
        return !state.running;
    });
    REQUIRE(done);
    CHECK(looks >= 1);
    CHECK(share > 0);
    CHECK(background.state().error.empty());
    REQUIRE(background.latest());
    CHECK(background.latest()->complete);
    CHECK(equal(*background.latest(), expected));
}

TEST_CASE("a new start drops the old one at once") {
    BackgroundTruth background;
    TruthSettings endless{.leastSamples = 1 << 18, .mostSamples = 1 << 18, .background = true};
    background.start(sphereInput({320, 240}), endless);
    REQUIRE(waitUntil([&] { return background.latest() != nullptr; }));
    CHECK_FALSE(background.latest()->complete);

    const TruthInput other = inputOf(closedFormSession(closedForms[1], {40, 30}));
    const TruthSettings settings{.leastSamples = 64, .mostSamples = 64};
    background.start(other, settings);
    CHECK(background.latest() == nullptr); // nothing of the old one is shown
    REQUIRE(waitUntil([&] { return !background.state().running; }));
    REQUIRE(background.latest());
    CHECK(equal(*background.latest(), traceTruth(other, settings)));

    background.start(sphereInput({320, 240}), endless);
    background.cancel();
    CHECK_FALSE(background.state().running);
    CHECK(background.latest() == nullptr);
    background.start(sphereInput({320, 240}), endless); // and the end of the program does not wait for it
}

TEST_CASE("a truth that waits can be cancelled") {
    Progress progress;
    progress.cancel();
    CHECK_THROWS_AS(traceTruth(sphereInput({80, 60}), {}, &progress), Cancelled);
}

TEST_CASE("a kept truth is found again, and a damaged one is not") {
    const TemporaryFolder folder;
    TruthFiles files(folder.path() / "deep" / "truth");
    const TruthInput input = sphereInput({40, 30});
    const TruthSettings settings{.leastSamples = 64, .mostSamples = 64, .cache = &files};
    const Truth traced = traceTruth(input, settings);
    CHECK_FALSE(traced.fromCache);
    const Truth found = traceTruth(input, settings);
    CHECK(found.fromCache);
    CHECK(found.complete);
    CHECK(equal(found, traced));
    CHECK_FALSE(files.find(traced.hash + 1));

    const fs::path file = files.fileOf(traced.hash);
    REQUIRE(fs::is_regular_file(file));
    const auto size = fs::file_size(file);
    for (const size_t place : {size_t{0}, size_t{10}, size_t{30}, size_t(size) / 2, size_t(size) - 1}) {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(static_cast<std::streamoff>(place));
        const int byte = stream.get();
        stream.seekp(static_cast<std::streamoff>(place));
        stream.put(static_cast<char>(byte ^ 1));
        stream.close();
        CAPTURE(place);
        CHECK_FALSE(files.find(traced.hash));
        const Truth again = traceTruth(input, settings); // replaces it
        CHECK_FALSE(again.fromCache);
        CHECK(files.find(traced.hash));
    }
    for (const size_t left : {size_t{0}, size_t{8}, size_t{71}, size_t{72}, size_t(size) - 1}) {
        files.keep(traced);
        fs::resize_file(file, left);
        CHECK_FALSE(files.find(traced.hash));
    }
}

TEST_CASE("kept truths stay below their limit; those used longest ago go first") {
    const TemporaryFolder folder;
    Truth truth{.width = 100, .height = 100}; // 90 kB
    truth.psi.resize(10000), truth.standardError.resize(10000), truth.classes.resize(10000);
    TruthFiles files(folder.path(), 300000);
    const auto keep = [&](uint64_t hash) {
        truth.hash = hash;
        files.keep(truth);
        std::this_thread::sleep_for(std::chrono::milliseconds(20)); // file times are coarse
    };
    keep(1), keep(2), keep(3);
    CHECK(filesIn(folder.path()) == 3);
    CHECK(files.find(1)); // used now
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    keep(4);
    CHECK(filesIn(folder.path()) == 3);
    CHECK(files.find(1));
    CHECK_FALSE(files.find(2));
    CHECK(files.find(4));
    TruthFiles(folder.path(), 1000).keep(truth); // too large for it
    CHECK(filesIn(folder.path()) == 3);
}

TEST_CASE("a folder that cannot be written keeps nothing and troubles nobody") {
    TruthFiles nowhere(fs::path{});
    TruthFiles impossible("/proc/nowhere");
    Truth truth{.width = 1, .height = 1, .psi = {0}, .standardError = {0}, .classes = {PixelClass::NoSurface}};
    for (TruthFiles* files : {&nowhere, &impossible}) {
        CHECK_NOTHROW(files->keep(truth));
        CHECK_FALSE(files->find(0));
    }
}
