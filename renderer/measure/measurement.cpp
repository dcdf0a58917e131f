// SPDX-License-Identifier: MIT
#include "renderer/measure/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace penumbra {
namespace {

constexpr int warmUpFrames = 3;          // programs are compiled, textures have their memory
constexpr size_t mostSideBySide = 16;    // settings that take turns
constexpr double wantedAgreement = 0.05; // of the sum of the passes with the frame

bool isCost(Stage stage) { return stage == Stage::ShadowMap || stage == Stage::Prefilter || stage == Stage::Resolve; }

// One setting at work.
struct Lane {
    SettingResult result;
    std::unique_ptr<Renderer> renderer;
    std::vector<double> passSums; // one a measured frame
    std::vector<float> shadow, shadowBefore;
    std::vector<double> flickers;

    bool hasFrames() const { return !result.milliseconds.empty(); }
};

bool draws(const Lane& lane) { return lane.result.trouble.empty(); }

// ψ by shadow maps from that many points of the light, some a frame so that a cancellation is heard.
std::vector<float> sampledShadow(const Renderer& renderer, Session& session, int maps, Progress& progress) {
    constexpr int mapsPerFrame = 8;
    session.techniques.choose("light-sampling");
    ParameterSet& parameters = session.techniques.parameters();
    parameters.reset();
    parameters.at("samples").set(maps);
    parameters.at("maps-per-frame").set(mapsPerFrame);
    session.progressive = true;
    const std::unique_ptr<Renderer> other = renderer.sibling(session.timeStep == 0);
    const uint32_t frame = session.frame;
    for (int done = 0; done < maps; done += mapsPerFrame) {
        progress.report("drawing shadow maps", static_cast<double>(done) / maps);
        other->render(session);
        ++session.frame;
    }
    session.frame = frame;
    session.progressive = false;
    return other->read(other->shadow()).values;
}

} // namespace

class Measurer::Work {
public:
    Work(Session session, MeasurementPlan plan, Progress& progress)
        : session_(std::move(session))
        , plan_(std::move(plan))
        , progress_(progress)
        , start_(session_.time)
        , camera_(session_.camera) {
        if (!plan_.motion) return;
        if (movesCasters(*plan_.motion)) session_.timeStep = motionStep;
        rest_ = {session_.camera, session_.light, session_.time};
    }

    Measurement measure(std::vector<Setting> settings, int frames, Share share) {
        plan_.frames = frames;
        share_ = share;
        drawn_ = 0;
        draws_ = static_cast<double>(settings.size()) * (warmUpFrames + double(plan_.frames) * plan_.repeats);
        measurement_.results.clear();
        measurement_.complete = true;
        try {
            for (Setting& setting : settings) {
                Lane lane = prepare(std::move(setting));
                if (lanes_.size() == mostSideBySide || bytesHeld() + lane.result.bytes > session_.textureLimit)
                    finishLanes();
                lanes_.push_back(std::move(lane));
            }
            finishLanes();
        } catch (const Cancelled&) {
            measurement_.complete = false;
            collect();
        }
        return {std::move(measurement_.results), measurement_.complete, measurement_.truthSamples,
                measurement_.truthStandardError, measurement_.mapBias};
    }

    void tellTruth(Measurement& measurement) const {
        measurement.truthSamples = std::max(measurement.truthSamples, measurement_.truthSamples);
        measurement.truthStandardError = std::max(measurement_.truthStandardError, measurement.truthStandardError);
    }

private:
    void tell(const char* doing) { progress_.report(doing, std::lerp(share_.from, share_.to, drawn_ / draws_)); }

    uint64_t bytesHeld() const {
        uint64_t sum = 0;
        for (const Lane& lane : lanes_) sum += lane.result.bytes;
        return sum;
    }

    void place(int frame) {
        session_.frame = static_cast<uint32_t>(frame);
        if (plan_.motion) return penumbra::place(*plan_.motion, rest_, frame, session_);
        session_.time = start_ + frame * session_.timeStep;
        session_.camera = plan_.path ? plan_.path->at(frame) : camera_;
    }

    void draw(const Lane& lane, Timing timing) {
        const ParameterSet& values = lane.result.setting.parameters();
        session_.techniques.choose(values.owner());
        session_.techniques.parameters().copyValuesFrom(values);
        lane.renderer->render(session_, timing);
        ++drawn_;
    }

    // A lane that has drawn its first frames.
    Lane prepare(Setting setting) {
        Lane lane{SettingResult(std::move(setting)), nullptr, {}, {}, {}, {}};
        const bool still = session_.timeStep == 0;
        const Renderer* elder = anyRenderer();
        lane.renderer = elder ? elder->sibling(still) : std::make_unique<Renderer>();
        place(0);
        try {
            for (int i = 0; i < warmUpFrames; ++i) {
                tell("warming up");
                draw(lane, Timing::Off);
            }
        } catch (const InputError& error) {
            lane.result.trouble = error.what();
            drawn_ += double(plan_.frames) * plan_.repeats;
            return lane;
        }
        const Flow& flow = lane.renderer->flow();
        lane.result.bytes = flow.bytes();
        lane.result.maps =
            static_cast<int>(std::count_if(flow.passes().begin(), flow.passes().end(), [](const Flow::PassNode& pass) {
                return pass.stage == Stage::ShadowMap && std::holds_alternative<Draw>(pass.work);
            }));
        lane.result.costPasses = static_cast<int>(std::count_if(
            flow.passes().begin(), flow.passes().end(), [](const Flow::PassNode& pass) { return isCost(pass.stage); }));
        return lane;
    }

    const Renderer* anyRenderer() const {
        const auto found = std::find_if(lanes_.begin(), lanes_.end(), draws);
        return found == lanes_.end() ? first_.get() : found->renderer.get();
    }

    void finishLanes() {
        for (int repeat = 0; repeat < plan_.repeats; ++repeat) {
            for (Lane& lane : lanes_)
                if (draws(lane)) lane.renderer->reset();
            truthBefore_.reset();
            for (int frame = 0; frame < plan_.frames; ++frame) playRound(frame, repeat);
        }
        collect();
    }

    void playRound(int frame, int repeat) {
        place(frame);
        for (Lane& lane : lanes_) {
            if (!draws(lane)) continue;
            tell("measuring");
            time(lane);
        }
        if (repeat > 0) return;
        // A still view has one truth, which is known before the first errors are asked for.
        if (plan_.moves || !truth_) trace();
        const int firstChange = std::max(plan_.frames / 2, 1);
        if (!plan_.moves && frame < firstChange - 1 && frame < plan_.frames - 1) return;
        for (Lane& lane : lanes_) {
            if (!draws(lane)) continue;
            readShadow(lane);
            if (plan_.moves) {
                FrameResult& result = lane.result.frames[static_cast<size_t>(frame)];
                result.errors = errorsOf(lane.shadow, *truth_);
                result.standardError = truth_->meanPenumbraStandardError;
                if (plan_.heard) plan_.heard(lane.result.setting, frame, *result.errors);
            }
            if (frame >= firstChange && !plan_.path && plan_.motion != MotionEvent::CameraPan &&
                !lane.shadowBefore.empty()) {
                const Truth& truth = *truth_;
                const Truth& before = truthBefore_ ? *truthBefore_ : truth;
                lane.flickers.push_back(flicker({lane.shadowBefore, &before}, {lane.shadow, &truth}));
            }
        }
    }

    void time(Lane& lane) {
        using Clock = std::chrono::steady_clock;
        Renderer& renderer = *lane.renderer;
        glFinish();
        const Clock::time_point start = Clock::now();
        draw(lane, renderer.softwareRenderer() ? Timing::Finish : Timing::Queries);
        glFinish();
        renderer.pollTimes();
        record(lane, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }

    // `wall` is what the frame took by a clock of its own.
    void record(Lane& lane, double wall) {
        const TimedFrame& timed = lane.renderer->runner().timer().newest();
        SettingResult& result = lane.result;
        // A GPU works while the driver still hands over commands, so its frame is what its own clock says.
        const double whole = lane.renderer->softwareRenderer() ? wall : timed.milliseconds;
        std::array<double, std::tuple_size_v<decltype(result.stages)>> stages{};
        double sum = 0, cost = 0;
        for (const PassTime& pass : timed.passes) {
            const std::string& label = lane.renderer->flow().label(pass.label);
            auto known = std::find_if(result.passes.begin(), result.passes.end(),
                                      [&](const PassTimes& p) { return p.label == label; });
            if (known == result.passes.end()) known = result.passes.insert(known, {pass.stage, label, {}});
            known->milliseconds.push_back(pass.milliseconds);
            stages[static_cast<size_t>(pass.stage)] += pass.milliseconds;
            sum += pass.milliseconds;
            if (isCost(pass.stage)) cost += pass.milliseconds;
        }
        for (size_t stage = 0; stage < stages.size(); ++stage) result.stages[stage].push_back(stages[stage]);
        result.milliseconds.push_back(whole);
        result.costs.push_back(cost);
        lane.passSums.push_back(sum);
        if (!plan_.moves) return;
        if (result.frames.size() <= session_.frame) result.frames.resize(session_.frame + 1);
        FrameResult& frame = result.frames[session_.frame];
        frame.seconds = plan_.path     ? session_.frame * CameraPath::step
                        : plan_.motion ? session_.frame * motionStep
                                       : session_.time;
        frame.milliseconds.push_back(whole);
        frame.costs.push_back(cost);
    }

    void readShadow(Lane& lane) {
        lane.shadowBefore = std::move(lane.shadow);
        lane.shadow = lane.renderer->read(lane.renderer->shadow()).values;
    }

    void trace() {
        const auto drawn = std::find_if(lanes_.begin(), lanes_.end(), draws);
        if (drawn == lanes_.end()) return;
        if (plan_.moves) truthBefore_ = std::exchange(truth_, std::nullopt);
        truth_ = plan_.truth(*drawn->renderer, session_, progress_);
        measurement_.truthSamples = std::max(measurement_.truthSamples, truth_->samplesMost);
        measurement_.truthStandardError = std::max(truth_->meanPenumbraStandardError, measurement_.truthStandardError);
        if (!plan_.moves && plan_.biasMaps > 0)
            measurement_.mapBias =
                errorsOf(sampledShadow(*drawn->renderer, session_, plan_.biasMaps, progress_), *truth_).all.rmse;
    }

    // Ends the lanes that there are: their figures, as far as they got.
    void collect() {
        for (Lane& lane : lanes_) {
            SettingResult& result = lane.result;
            if (result.trouble.empty()) {
                if (!lane.hasFrames()) continue; // cancelled before
                finishErrors(lane);
                if (!result.errors && draws(lane)) continue; // cancelled before
                checkTimes(lane);
            }
            if (!first_ && result.trouble.empty()) first_ = std::move(lane.renderer);
            measurement_.results.push_back(std::move(result));
        }
        lanes_.clear();
    }

    void finishErrors(Lane& lane) {
        SettingResult& result = lane.result;
        if (plan_.moves) {
            std::vector<Errors> errors;
            // Cancelled between drawing and comparing: that frame is not done.
            std::erase_if(result.frames, [](const FrameResult& frame) { return !frame.errors; });
            for (const FrameResult& frame : result.frames) errors.push_back(*frame.errors);
            if (!errors.empty()) result.errors = together(errors);
        } else if (truth_) {
            const std::vector<float> shadow = lane.renderer->read(lane.renderer->shadow()).values;
            result.errors = errorsOf(shadow, *truth_);
        }
        if (!lane.flickers.empty()) {
            double sum = 0;
            for (const double f : lane.flickers) sum += f;
            result.flicker = sum / static_cast<double>(lane.flickers.size());
        }
        if (result.errors && result.errors->notFinite > 0) {
            result.trouble = fmt::format("{} pixels of its shadow image are not finite", result.errors->notFinite);
            result.errors.reset();
        }
    }

    // The passes must add up to the frame, or the times mean nothing.
    static void checkTimes(Lane& lane) {
        SettingResult& result = lane.result;
        const double ratio = medianRatio(lane.passSums, result.milliseconds).median;
        if (std::abs(ratio - 1) <= wantedAgreement) return;
        result.trouble += fmt::format("{}no times: the passes add up to {:.0f} percent of the frame",
                                      result.trouble.empty() ? "" : "; ", 100 * ratio);
        result.milliseconds.clear();
        result.costs.clear();
        for (std::vector<double>& stage : result.stages) stage.clear();
        result.passes.clear();
        for (FrameResult& frame : result.frames) {
            frame.milliseconds.clear();
            frame.costs.clear();
        }
    }

    Session session_;
    MeasurementPlan plan_;
    Progress& progress_;
    const double start_;
    const Camera camera_;
    Rest rest_; // before a motion
    Measurement measurement_;
    std::unique_ptr<Renderer> first_; // one that others are siblings of, when its lane is done
    std::vector<Lane> lanes_;
    std::optional<Truth> truth_, truthBefore_; // of the frame, or of the still view; of the frame before
    double drawn_ = 0, draws_ = 1;             // frames so far, in all
    Share share_;
};

TruthOfView tracedTruth(const TruthSettings& settings) {
    return [settings](const Renderer& renderer, Session& session, Progress& progress) {
        return traceTruth(readTruthInput(renderer, session), settings, &progress);
    };
}

TruthOfView sampledTruth(int maps) {
    TechniqueShelf().parametersOf("light-sampling").at("samples").set(maps); // refused with the range
    return [maps](const Renderer& renderer, Session& session, Progress& progress) {
        // The classes of the pixels do not depend on the number of rays.
        Truth truth = traceTruth(readTruthInput(renderer, session), {.leastSamples = 1, .mostSamples = 1}, &progress);
        truth.psi = sampledShadow(renderer, session, maps, progress);
        truth.samplesLeast = truth.samplesMost = maps;
        truth.samplesMean = maps;
        truth.standardError.assign(truth.psi.size(), std::numeric_limits<float>::quiet_NaN());
        truth.meanPenumbraStandardError = std::numeric_limits<double>::quiet_NaN();
        return truth;
    };
}

Measurement measure(Session session, std::vector<Setting> settings, const MeasurementPlan& plan, Progress& progress) {
    return Measurer(std::move(session), plan, progress).measure(std::move(settings));
}

Measurer::Measurer(Session session, MeasurementPlan plan, Progress& progress)
    : work_(std::make_unique<Work>(std::move(session), plan, progress))
    , frames_(plan.frames) {}

Measurer::~Measurer() = default;
Measurer::Measurer(Measurer&&) noexcept = default;

Measurement Measurer::measure(std::vector<Setting> settings) { return measure(std::move(settings), frames_, {}); }

Measurement Measurer::measure(std::vector<Setting> settings, int frames, Share share) {
    return work_->measure(std::move(settings), frames, share);
}

void Measurer::tellTruth(Measurement& measurement) const { work_->tellTruth(measurement); }

Errors together(std::span<const Errors> errors) {
    Errors sum;
    double squares = 0, penumbraSquares = 0;
    const auto add = [](ErrorFigures& to, const ErrorFigures& from, double pixels, double frames) {
        to.meanAbsolute += from.meanAbsolute * pixels;
        to.bias += from.bias * pixels;
        to.p95 += from.p95 / frames;
        to.p99 += from.p99 / frames;
        to.max = std::max(to.max, from.max);
    };
    const auto frames = static_cast<double>(errors.size());
    for (const Errors& e : errors) {
        const auto pixels = static_cast<double>(e.pixels), penumbra = static_cast<double>(e.penumbraPixels);
        const double ownSquares = e.all.rmse * e.all.rmse * pixels;
        add(sum.all, e.all, pixels, frames);
        add(sum.penumbra, e.penumbra, penumbra, frames);
        squares += ownSquares;
        penumbraSquares += e.penumbra.rmse * e.penumbra.rmse * penumbra;
        for (size_t k = 0; k < errorKinds; ++k) sum.share[k] += e.share[k] * ownSquares;
        sum.pixels += e.pixels;
        sum.penumbraPixels += e.penumbraPixels;
        sum.cutByHorizon += e.cutByHorizon;
        sum.notFinite += e.notFinite;
    }
    const auto divide = [](ErrorFigures& figures, double allSquares, size_t count) {
        const double n = std::max(static_cast<double>(count), 1.0);
        figures.rmse = std::sqrt(allSquares / n);
        figures.meanAbsolute /= n;
        figures.bias /= n;
    };
    divide(sum.all, squares, sum.pixels);
    divide(sum.penumbra, penumbraSquares, sum.penumbraPixels);
    for (double& share : sum.share) share = squares > 0 ? share / squares : 0;
    return sum;
}

std::vector<std::string> doubtsAboutTimes(const Renderer& renderer, bool waitsForDisplay) {
    std::vector<std::string> doubts;
#ifndef NDEBUG
    doubts.push_back("this is a debug build: times are not those of a release build");
#endif
    if (renderer.softwareRenderer())
        doubts.push_back("a software renderer draws: times are the processor's, and passes are finished one by one");
    if (waitsForDisplay) doubts.push_back("frames wait for the display (vertical sync): they take as long as it does");
    return doubts;
}

} // namespace penumbra
