// SPDX-License-Identifier: MIT
// The truth ψ*: for every pixel of a view the share of the light's area that the surface there does not see, by ray
// tracing on the CPU. It is not weighted by irradiance; a point of the light below the surface's geometric horizon is
// one that it does not see. No OpenGL but for readTruthInput().
#pragma once

#include "renderer/core/progress.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

class Renderer;
struct Session;

// How a pixel's surface stands to the light. Errors of techniques are taken over FacesWholeLight.
enum class PixelClass : uint8_t {
    NoSurface,       // ψ* = 0
    FacesWholeLight, // every point of the light is above the surface's geometric horizon
    CutByHorizon,    // some points are below it
    FacesAway,       // all are: ψ* = 1
    BehindLight,     // the surface faces the light's back, which does not shine: ψ* = 0, as all techniques have it
};

// What is asked: surfaces of a view, what casts, and a light.
struct TruthInput {
    View view;                          // size: width, height
    std::vector<float> depth;           // eye depth [m], 0: no surface; one a pixel, row 0 at the top
    std::vector<glm::vec2> normal;      // octahedral, of the world, geometric, towards the viewer
    std::shared_ptr<const Scene> scene; // what it shows casts; see renderer/truth/casters.h
    Pose pose;                          // of the scene
    AreaLight light;
    uint32_t seed = 0;
};
// Of the frame that the renderer has drawn of this session, from the images scene.depth and scene.normal. Stalls.
TruthInput readTruthInput(const Renderer& renderer, const Session& session);

struct Truth;
// Where truths are kept that are known already; called from the thread that traces.
class TruthCache {
public:
    virtual ~TruthCache() = default;
    virtual std::optional<Truth> find(uint64_t hash) = 0; // of Truth::hash
    virtual void keep(const Truth& truth) = 0;
};

struct TruthSettings {
    int leastSamples = 256;             // rays a pixel, at least; rounded up to a multiple of 16
    int mostSamples = 16384;            // and at most; equal: the same for every pixel
    double wantedStandardError = 0.001; // it ends when the mean over penumbra pixels is below this
    int threads = 0;                    // 0: one per core
    bool shafts = true;                 // no rays where they can say only one thing; see renderer/truth/shafts.h
    bool background = false;            // threads of low priority, that leave the cores to whoever draws
    TruthCache* cache = nullptr;        // asked first, and given what was traced; app/truth_cache.h has one on disk
};
inline constexpr int truthReplicates = 8; // independently shifted Halton sequences a pixel

struct Truth {
    int width = 0, height = 0;        // row 0 at the top, as Renderer::Pixels has it
    std::vector<float> psi;           // ψ* in [0, 1]
    std::vector<float> standardError; // of psi; 0 where rays can say only one thing
    std::vector<PixelClass> classes;
    int samplesLeast = 0, samplesMost = 0; // rays a pixel, of those that only rays can tell of
    double samplesMean = 0;                // over all that any ray was sent from
    double meanPenumbraStandardError = 0; // over pixels with ψ* in (0.01, 0.99); 0 without any
    int penumbraPixels = 0;
    bool complete = false; // false: a first look, that is still being refined
    bool fromCache = false;
    double seconds = 0; // that it took when it was traced
    uint64_t hash = 0;  // of everything that it depends on

    bool isPenumbra(size_t pixel) const { return psi[pixel] > 0.01f && psi[pixel] < 0.99f; }
};

// Traces it and waits. The same input and settings give the same truth to the last bit, on any number of threads.
// Throws Cancelled if `progress` is told so.
Truth traceTruth(const TruthInput& input, const TruthSettings& settings = {}, Progress* progress = nullptr);

// Traces it on threads of its own while the caller goes on.
class BackgroundTruth {
public:
    BackgroundTruth();
    ~BackgroundTruth(); // cancels and waits
    BackgroundTruth(const BackgroundTruth&) = delete;
    BackgroundTruth& operator=(const BackgroundTruth&) = delete;

    // Drops what runs and starts anew. Does not wait.
    void start(TruthInput input, const TruthSettings& settings);
    void cancel();

    struct State {
        bool running = false;
        double share = 0;       // done, in [0, 1]
        double secondsLeft = 0; // estimated; negative: not known yet
        std::string error;      // one line, if it failed
    };
    State state() const;
    // The newest picture of the input that was started last, or null; another pointer whenever there is a newer one.
    std::shared_ptr<const Truth> latest() const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

} // namespace penumbra
