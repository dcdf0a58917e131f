// SPDX-License-Identifier: MIT
#include "renderer/truth/truth.h"

#include "renderer/core/hash.h"
#include "renderer/renderer.h"
#include "renderer/truth/tracer.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Another number makes all kept truths old: for a change of what is traced.
constexpr uint32_t traceVersion = 5;

uint64_t hashOf(const TruthInput& input, const TruthSettings& settings, const Casters& casters) {
    Hash hash;
    hash.add(traceVersion);
    hash.add(casters.hash());
    hash.add(input.depth);
    hash.add(input.normal);
    const View& view = input.view;
    for (const glm::vec3& v : {view.eyeWorld, view.rayCorner, view.rayDx, view.rayDy, input.light.position,
                               input.light.target, glm::vec3(halfSize(input.light), 0)})
        hash.addBytes(&v, sizeof(v));
    hash.addBytes(&view.size, sizeof(view.size));
    hash.add(input.light.shape);
    hash.add(input.seed);
    hash.add(settings.leastSamples);
    hash.add(settings.mostSamples);
    hash.add(settings.wantedStandardError);
    hash.add(settings.shafts);
    return hash.value();
}

// `casters` may hold those of an earlier trace; they are kept if they fit. `show` hears of every round but the last.
Truth trace(const TruthInput& input, const TruthSettings& settings, Crew& crew, int threads,
            std::unique_ptr<Casters>& casters, Progress* progress, const std::function<void(Truth)>& show) {
    const Clock::time_point start = Clock::now();
    if (!casters || !casters->isOf(input.scene, input.pose, input.light)) {
        casters.reset();
        casters = std::make_unique<Casters>(input.scene, input.pose, input.light, threads, progress);
    }
    const uint64_t hash = hashOf(input, settings, *casters);
    if (settings.cache)
        if (std::optional<Truth> kept = settings.cache->find(hash)) return *std::move(kept);

    Tracer tracer(input, settings, *casters, crew);
    while (tracer.next(progress))
        if (show) show(tracer.truth());
    Truth truth = tracer.truth();
    truth.complete = true;
    truth.seconds = secondsSince(start);
    truth.hash = hash;
    if (settings.cache) settings.cache->keep(truth);
    return truth;
}

} // namespace

TruthInput readTruthInput(const Renderer& renderer, const Session& session) {
    const Flow& flow = renderer.flow();
    const auto image = [&](std::string_view label) {
        const std::optional<Image> found = flow.find(label);
        ensure(found.has_value(), "a truth was asked for without a frame");
        return *found;
    };
    TruthInput input{.view = sessionView(session, renderer.state().bounds()),
                     .depth = renderer.readPicture(image("scene.depth")).values,
                     .scene = session.scene,
                     .pose = renderer.state().pose(),
                     .light = session.light,
                     .seed = session.seed};
    const Renderer::Pixels normals = renderer.readPicture(image("scene.normal"));
    const size_t pixels = input.depth.size();
    ensure(normals.values.size() == 4 * pixels, "depth and normals are of different sizes");
    input.normal.reserve(pixels);
    for (size_t i = 0; i < pixels; ++i) input.normal.emplace_back(normals.values[4 * i], normals.values[4 * i + 1]);
    return input;
}

Truth traceTruth(const TruthInput& input, const TruthSettings& settings, Progress* progress) {
    const int threads = crewSize(settings.threads);
    std::unique_ptr<Casters> casters;
    const auto run = [&] {
        Crew crew(threads);
        return trace(input, settings, crew, threads, casters, progress, {});
    };
    if (!settings.background) return run();
    // On a thread of its own: one that has stepped back cannot step forward again.
    Truth truth;
    std::exception_ptr failure;
    std::thread([&] {
        stepBack();
        try {
            truth = run();
        } catch (...) {
            failure = std::current_exception();
        }
    }).join();
    if (failure) std::rethrow_exception(failure);
    return truth;
}

// One thread that always traces what was started last.
struct BackgroundTruth::Work {
    struct Job {
        TruthInput input;
        TruthSettings settings;
        std::shared_ptr<Progress> progress = std::make_shared<Progress>();
    };

    std::mutex mutex;
    std::condition_variable changed;
    std::unique_ptr<Job> waiting;
    std::shared_ptr<Progress> current; // of the job that waits or runs
    Clock::time_point started;         // when it began to run
    std::shared_ptr<const Truth> latest;
    std::string error;
    bool over = false;
    std::thread thread{[this] { run(); }};

    void drop() { // with the lock held
        if (current) current->cancel();
        current.reset();
        waiting.reset();
        latest.reset();
        error.clear();
    }

    void run() {
        std::unique_ptr<Casters> casters;
        std::unique_ptr<Crew> crew;
        int crewThreads = 0;
        bool stepped = false;
        while (true) {
            std::unique_ptr<Job> job;
            {
                std::unique_lock lock(mutex);
                changed.wait(lock, [&] { return over || waiting; });
                if (over) return;
                job = std::move(waiting);
                started = Clock::now();
            }
            if (job->settings.background && !stepped) {
                stepBack();
                stepped = true;
                crew.reset();
            }
            const int threads = crewSize(job->settings.threads);
            if (!crew || crewThreads != threads) crew = std::make_unique<Crew>(threads);
            crewThreads = threads;
            const auto publish = [&](Truth truth) {
                auto shared = std::make_shared<const Truth>(std::move(truth));
                const std::lock_guard lock(mutex);
                if (current == job->progress) latest = std::move(shared);
            };
            const auto finish = [&](std::string message) {
                const std::lock_guard lock(mutex);
                if (current != job->progress) return;
                error = std::move(message);
                current.reset();
            };
            try {
                publish(trace(job->input, job->settings, *crew, threads, casters, job->progress.get(), publish));
                finish({});
            } catch (const Cancelled&) {
                finish({});
            } catch (const std::exception& failure) {
                finish(failure.what());
            }
        }
    }
};

BackgroundTruth::BackgroundTruth() : work_(std::make_unique<Work>()) {}

BackgroundTruth::~BackgroundTruth() {
    {
        const std::lock_guard lock(work_->mutex);
        work_->drop();
        work_->over = true;
    }
    work_->changed.notify_one();
    work_->thread.join();
}

void BackgroundTruth::start(TruthInput input, const TruthSettings& settings) {
    auto job = std::make_unique<Work::Job>(Work::Job{std::move(input), settings});
    {
        const std::lock_guard lock(work_->mutex);
        work_->drop();
        work_->current = job->progress;
        work_->started = Clock::now();
        work_->waiting = std::move(job);
    }
    work_->changed.notify_one();
}

void BackgroundTruth::cancel() {
    const std::lock_guard lock(work_->mutex);
    work_->drop();
}

BackgroundTruth::State BackgroundTruth::state() const {
    const std::lock_guard lock(work_->mutex);
    State state{.error = work_->error};
    if (!work_->current) return state;
    state.running = true;
    state.share = work_->current->share();
    const double spent = secondsSince(work_->started);
    state.secondsLeft = state.share > 0.01 ? spent * (1 - state.share) / state.share : -1;
    return state;
}

std::shared_ptr<const Truth> BackgroundTruth::latest() const {
    const std::lock_guard lock(work_->mutex);
    return work_->latest;
}

} // namespace penumbra
