// SPDX-License-Identifier: MIT
// How long the truth takes. Not part of the suite: test-truth "[figures]"; PENUMBRA_FIGURE_SCENE names another scene.
#include "renderer/truth/casters.h"
#include "renderer/truth/truth.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <sys/resource.h>

using namespace penumbra;
using namespace penumbra::test;

namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double processorSeconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

} // namespace

TEST_CASE("what the truth costs at 640x480", "[.][figures]") {
    const char* wanted = std::getenv("PENUMBRA_FIGURE_SCENE");
    Session s;
    s.setScene(std::make_shared<const Scene>(importGltf(findScene(wanted ? wanted : "courtyard"))));
    s.size = {640, 480};
    renderer().render(s);
    const TruthInput input = readTruthInput(renderer(), s);

    {
        const Clock::time_point start = Clock::now();
        const double processor = processorSeconds();
        const Casters casters(input.scene, input.pose, input.light, 2, nullptr);
        WARN("posing, hashing and the hierarchy: " << since(start) << " s, " << processorSeconds() - processor
                                                   << " s of processor time");
    }
    for (int run = 0; run < 3; ++run) {
        const Clock::time_point start = Clock::now();
        const double processor = processorSeconds();
        const Truth truth = traceTruth(input, {.leastSamples = 256, .mostSamples = 256});
        const double seconds = since(start), spent = processorSeconds() - processor;
        size_t traced = 0;
        for (const PixelClass kind : truth.classes)
            traced += kind == PixelClass::FacesWholeLight || kind == PixelClass::CutByHorizon;
        const auto asked = std::count_if(truth.standardError.begin(), truth.standardError.end(),
                                         [](float error) { return error > 0; });
        WARN(s.scene->name << ": " << s.scene->triangleCount() << " triangles, " << traced << " pixels of "
                           << truth.classes.size() << " with 256 rays (" << asked << " by rays alone): " << seconds
                           << " s, " << spent << " s of processor time, "
                           << 1e9 * spent / (256.0 * static_cast<double>(traced)) << " ns a ray; mean penumbra error "
                           << truth.meanPenumbraStandardError);
    }
    BackgroundTruth background;
    Clock::time_point start = Clock::now();
    const double processor = processorSeconds();
    background.start(input, {.background = true});
    while (!background.latest()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    WARN("first picture: " << since(start) << " s, " << processorSeconds() - processor << " s of processor time, "
                           << background.latest()->samplesMean << " rays a pixel");
    while (background.state().running) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Truth& last = *background.latest();
    WARN("to an error of 0.001: " << last.seconds << " s, " << last.samplesMean << " rays a pixel on average, "
                                  << last.samplesLeast << " to " << last.samplesMost << "; mean penumbra error "
                                  << last.meanPenumbraStandardError << " over " << last.penumbraPixels << " pixels");
    start = Clock::now();
    background.start(input, {.background = true}); // its hierarchy is there already
    while (!background.latest()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    WARN("first picture of another view of the same scene: " << since(start) << " s");
}
