// SPDX-License-Identifier: MIT
// Measures settings side by side: what each costs and how far it is from the truth.
//
// Frames are drawn in rounds, one frame of each setting a round (A B C, A B C ...), so that a drift of the machine hits
// all alike. Every setting has images and a history of its own. Only times depend on the machine: the same input gives
// the same errors to the last digit.
#pragma once

#include "renderer/measure/camera_path.h"
#include "renderer/measure/combinations.h"
#include "renderer/measure/errors.h"
#include "renderer/measure/motion.h"
#include "renderer/measure/statistics.h"
#include "renderer/renderer.h"

#include <functional>
#include <optional>

namespace penumbra {

// The truth of what a renderer has drawn last of a session, whose techniques it may change.
using TruthOfView = std::function<Truth(const Renderer& renderer, Session& session, Progress& progress)>;
// By rays.
TruthOfView tracedTruth(const TruthSettings& settings);
// By shadow maps from that many points of the light. Its standard error is not known: NaN.
TruthOfView sampledTruth(int maps);

struct MeasurementPlan {
    int frames = 20;    // measured, after a warm-up that leaves no trace in any history
    int repeats = 1;    // of all frames, each from an empty history
    bool moves = false; // every frame is compared with a truth of its own; else the last one with that of the view
    std::optional<CameraPath> path;    // of the camera; it moves, then
    std::optional<MotionEvent> motion; // what happens; it moves, then
    TruthOfView truth;
    // Hears of every frame of a setting as soon as it is compared with a truth of its own.
    std::function<void(const Setting& setting, int frame, const Errors& errors)> heard = {};
    int biasMaps = 0; // if there are, and the view is still, that many shadow maps are compared with the truth
};

// One pass, or all passes of one label, over the measured frames.
struct PassTimes {
    Stage stage;
    std::string label;
    std::vector<double> milliseconds;
};

// One frame of a sequence.
struct FrameResult {
    double seconds = 0; // of the scene's time, or along the path
    std::optional<Errors> errors;
    double standardError = 0;                // of its truth
    std::vector<double> milliseconds, costs; // one a repeat
};

struct SettingResult {
    explicit SettingResult(Setting measured) : setting(std::move(measured)) {}
    Setting setting;
    std::vector<double> milliseconds;          // of the whole frame, one a measured frame
    std::vector<double> costs;                 // of ShadowMap, Prefilter and Resolve together
    std::array<std::vector<double>, 6> stages; // by Stage, one a measured frame
    std::vector<PassTimes> passes;
    uint64_t bytes = 0;              // of textures that the frame holds
    int maps = 0;                    // shadow maps that it draws
    int costPasses = 0;              // passes of ShadowMap, Prefilter and Resolve
    std::optional<Errors> errors;    // of the last frame; of all frames where it moves
    std::optional<double> flicker;   // over the second half of the frames, of a camera at rest
    std::vector<FrameResult> frames; // where it moves
    std::string trouble;             // why it has no figures, or no times
};

struct Measurement {
    std::vector<SettingResult> results; // in the order asked for; after a cancellation those that have a frame
    bool complete = true;               // false: it was cancelled
    int truthSamples = 0;               // rays a pixel or maps, the most of any truth
    double truthStandardError = 0;      // mean over penumbra pixels, the worst of any truth
    std::optional<double> mapBias;      // RMSE of plan.biasMaps: what of an error is due to shadow maps as such
};

// Draws in the current context. Settings that cannot be drawn (more textures than session.textureLimit) have a trouble
// instead of figures. A cancellation through `progress` keeps what is done.
Measurement measure(Session session, std::vector<Setting> settings, const MeasurementPlan& plan, Progress& progress);

// Measures batch after batch of settings in one view: the scene, the programs and, where nothing moves, the truth are
// kept in between. All in one context, which is current.
class Measurer {
public:
    Measurer(Session session, MeasurementPlan plan, Progress& progress);
    ~Measurer();
    Measurer(Measurer&&) noexcept;

    // What a batch is of all that `progress` tells of.
    struct Share {
        double from = 0, to = 1;
    };
    Measurement measure(std::vector<Setting> settings); // as planned
    Measurement measure(std::vector<Setting> settings, int frames, Share share);
    // Notes its truth in `measurement`: the most samples and the worst standard error of several.
    void tellTruth(Measurement& measurement) const;

private:
    class Work;
    std::unique_ptr<Work> work_;
    int frames_;
};

// The figures of several frames as one: pixels weigh alike, percentiles are means over the frames.
Errors together(std::span<const Errors> errors);

// What makes times doubtful, one line each: a debug build, a software renderer, a display that is waited for.
std::vector<std::string> doubtsAboutTimes(const Renderer& renderer, bool waitsForDisplay);

} // namespace penumbra
