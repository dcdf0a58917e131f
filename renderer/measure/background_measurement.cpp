// SPDX-License-Identifier: MIT
#include "renderer/measure/background_measurement.h"

namespace penumbra {
namespace {

// Beside a window that must stay alive: a quick look first, so that there is something to see.
constexpr int quickFrames = 6, frames = 20;
constexpr double quickShare = 0.35; // of the time, of a first look with its truth

MeasurementPlan planWith(TruthSettings truth) {
    MeasurementPlan plan;
    plan.truth = tracedTruth(truth);
    return plan;
}

} // namespace

Session stillView(const Session& session) {
    Session view;
    view.scene = session.scene;
    view.camera = session.camera;
    view.light = session.light;
    view.ground = session.ground;
    view.clip = session.clip;
    view.time = session.time;
    view.seed = session.seed;
    view.size = session.size;
    view.textureLimit = session.textureLimit;
    return view;
}

void BackgroundMeasurement::measure(Session view, std::vector<Setting> settings, TruthSettings truth) {
    letterbox_ = std::make_shared<Letterbox>();
    work_.start([this, letterbox = letterbox_, view = std::move(view), settings = std::move(settings),
                 truth](Progress& progress) mutable {
        const SideContext::Use current(context_);
        Measurer measurer(std::move(view), planWith(truth), progress);
        const auto run = [&](std::vector<Setting> some, int count, Measurer::Share share) {
            Measurement measurement = measurer.measure(std::move(some), count, share);
            for (SettingResult& result : measurement.results) letterbox->put(std::move(result));
            return measurement.complete;
        };
        for (size_t i = 0; i < settings.size(); ++i) {
            const auto share = [&](size_t done) { return quickShare * double(done) / double(settings.size()); };
            std::vector<Setting> one;
            one.push_back(settings[i].copy());
            if (!run(std::move(one), quickFrames, {share(i), share(i + 1)})) return End{{}, false};
        }
        if (!run(std::move(settings), frames, {quickShare, 1})) return End{{}, false};
        return End{};
    });
}

void BackgroundMeasurement::search(std::vector<Session> views, Question question, TruthSettings truth) {
    letterbox_ = std::make_shared<Letterbox>();
    work_.start([this, letterbox = letterbox_, views = std::move(views), question = std::move(question),
                 truth](Progress& progress) mutable {
        const SideContext::Use current(context_);
        std::vector<Measurer> measurers;
        for (Session& view : views) measurers.emplace_back(std::move(view), planWith(truth), progress);
        const Evaluate evaluate = measuredIn(measurers, checkFree(question.starts, question.free),
                                             [&](SettingResult result) { letterbox->put(std::move(result)); });
        BudgetSearch found = searchBudget(question.starts, question.free, question.budget, evaluate);
        const bool complete = found.complete;
        return End{std::move(found), complete};
    });
}

void BackgroundMeasurement::move(Session view, std::vector<Setting> settings, MotionEvent motion, int count,
                                 TruthSettings truth) {
    letterbox_ = std::make_shared<Letterbox>();
    for (size_t i = 0; i < settings.size(); ++i) settings[i].place = i;
    work_.start([this, letterbox = letterbox_, view = std::move(view), settings = std::move(settings), motion, count,
                 truth](Progress& progress) mutable {
        const SideContext::Use current(context_);
        MeasurementPlan plan = planWith(truth);
        plan.motion = motion;
        plan.moves = true;
        plan.frames = count;
        plan.heard = [&](const Setting& setting, int frame, const Errors& errors) {
            const std::lock_guard lock(letterbox->mutex);
            letterbox->frames.push_back({setting.place, frame, errors.all.rmse, errors.penumbra.rmse});
        };
        Measurement measurement = penumbra::measure(std::move(view), std::move(settings), plan, progress);
        for (SettingResult& result : measurement.results) letterbox->put(std::move(result));
        return End{{}, measurement.complete};
    });
}

std::vector<BackgroundMeasurement::MovedFrame> BackgroundMeasurement::takeFrames() {
    if (!letterbox_) return {};
    const std::lock_guard lock(letterbox_->mutex);
    return std::exchange(letterbox_->frames, {});
}

std::vector<SettingResult> BackgroundMeasurement::take() {
    if (!letterbox_) return {};
    const std::lock_guard lock(letterbox_->mutex);
    return std::exchange(letterbox_->results, {});
}

} // namespace penumbra
