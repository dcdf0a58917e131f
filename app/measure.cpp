// SPDX-License-Identifier: MIT
#include "app/measure.h"

#include "app/command_line.h"
#include "app/file_io.h"
#include "app/headless.h"
#include "app/measurement_report.h"
#include "app/preset.h"
#include "app/progress_line.h"
#include "app/truth_cache.h"
#include "renderer/core/hash.h"
#include "renderer/measure/budget.h"
#include "renderer/measure/irradiance.h"
#include "renderer/measure/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <csignal>

namespace penumbra {
namespace {

constexpr int defaultFrames = 20;

// --- what is measured ----------------------------------------------------------------------------------------------

std::vector<std::string> commaList(std::string_view text) {
    std::vector<std::string> pieces;
    for (size_t end; (end = text.find(',')) != std::string_view::npos; text.remove_prefix(end + 1))
        pieces.emplace_back(text.substr(0, end));
    pieces.emplace_back(text);
    return pieces;
}

std::vector<Setting> chosenSettings(const Options& options) {
    std::vector<Setting> settings;
    const bool all = options.techniques ? *options.techniques == "all" : !options.technique && !options.preset;
    if (all)
        for (const Card* card : catalogue()) settings.emplace_back(*card);
    else if (options.techniques)
        for (const std::string& id : commaList(*options.techniques)) settings.emplace_back(findCard(id));
    else if (options.technique)
        settings.emplace_back(findCard(*options.technique));
    if (options.preset)
        for (const std::string& preset : commaList(*options.preset)) {
            TechniqueShelf shelf;
            loadPreset(findPreset(preset), shelf);
            settings.emplace_back(shelf.card(), shelf.parameters());
        }
    return settings;
}

std::vector<Setting> combinations(const Options& options) {
    std::vector<SweepAxis> axes;
    for (const std::string& sweep : options.sweeps) axes.push_back(parseSweep(sweep));
    std::vector<Setting> settings = chosenSettings(options);
    for (const std::string& assignment : options.assignments) assign(settings, assignment);
    std::vector<Setting> all = combine(std::move(settings), axes);

    size_t part = 0, parts = 1;
    if (options.shard) {
        const std::string& text = *options.shard;
        const size_t slash = std::min(text.find('/'), text.size());
        const char *middle = text.data() + slash, *end = text.data() + text.size();
        const auto first = std::from_chars(text.data(), middle, part);
        const auto second = middle < end ? std::from_chars(middle + 1, end, parts) : first;
        if (middle == end || first.ec != std::errc() || first.ptr != middle || second.ec != std::errc() ||
            second.ptr != end || part < 1 || part > parts)
            throw InputError(fmt::format("--shard: '{}' is not I/N, whole numbers with 1 <= I <= N", text));
        --part;
    }
    std::vector<Setting> chosen;
    for (size_t i = part; i < all.size(); i += parts) chosen.push_back(std::move(all[i]));
    return chosen;
}

std::optional<MotionEvent> motionOf(const Options& options) {
    if (!options.motion) return std::nullopt;
    if (options.path || options.play)
        throw InputError(fmt::format("--motion and {}: one of them was expected", options.path ? "--path" : "--play"));
    const std::span<const std::string_view> names = motionNames();
    const auto found = std::find(names.begin(), names.end(), *options.motion);
    if (found == names.end())
        throw InputError(fmt::format("--motion: '{}' is not one of {}{}", *options.motion, fmt::join(names, ", "),
                                     suggestion(*options.motion, names)));
    return static_cast<MotionEvent>(found - names.begin());
}

MeasurementPlan makePlan(const Options& options, const Session& session) {
    MeasurementPlan plan;
    if (options.path) {
        const std::string& path = *options.path;
        if (path == "orbit") {
            plan.path = CameraPath::orbit(session.camera);
        } else if (path == "walk") {
            plan.path = CameraPath::walk(session.camera);
        } else {
            try {
                plan.path = CameraPath::parse(readFile(path, 16 << 20), session.camera);
            } catch (const InputError& error) {
                const std::string message = error.what();
                throw InputError(
                    fmt::format("--path: {}", message.starts_with(path) ? message : path + ": " + message));
            }
        }
    }
    plan.motion = motionOf(options);
    if (plan.motion && movesCasters(*plan.motion) && session.scene->duration(session.clip) <= 0)
        throw InputError(fmt::format("--motion: nothing moves in {}; {} needs an animation", session.scene->name,
                                     motionNames()[static_cast<size_t>(*plan.motion)]));
    plan.moves = plan.path || plan.motion || session.timeStep != 0;
    plan.frames = options.frames.value_or(plan.path ? plan.path->frames() : plan.motion ? motionFrames : defaultFrames);
    if (plan.motion && plan.frames <= eventFrame)
        throw InputError(
            fmt::format("--frames: more than {} were expected with --motion, which begins then", eventFrame));
    if (plan.path && plan.frames > plan.path->frames())
        throw InputError(
            fmt::format("--frames: {} is more than the {} frames of the path", plan.frames, plan.path->frames()));
    plan.repeats = options.repeat.value_or(1);
    return plan;
}

// --- the document --------------------------------------------------------------------------------------------------

Json intervalJson(const TimeSummary& summary) {
    return {{"median", summary.median},
            {"p95", summary.p95},
            {"low", summary.interval.low},
            {"high", summary.interval.high}};
}

Json figuresJson(const Errors& errors) {
    Json json = {{"rmse", errors.all.rmse},
                 {"mean_abs", errors.all.meanAbsolute},
                 {"bias", errors.all.bias},
                 {"p95", errors.all.p95},
                 {"p99", errors.all.p99},
                 {"max", errors.all.max},
                 {"penumbra_rmse", errors.penumbra.rmse},
                 {"penumbra_mean_abs", errors.penumbra.meanAbsolute},
                 {"penumbra_bias", errors.penumbra.bias},
                 {"penumbra_p95", errors.penumbra.p95},
                 {"penumbra_p99", errors.penumbra.p99},
                 {"penumbra_max", errors.penumbra.max}};
    static constexpr const char* kinds[errorKinds] = {"leak", "false_shadow", "noise", "wide", "narrow"};
    for (size_t k = 0; k < errorKinds; ++k) json[kinds[k]] = errors.share[k];
    json["pixels"] = errors.pixels;
    json["penumbra_pixels"] = errors.penumbraPixels;
    json["cut_by_horizon"] = errors.cutByHorizon;
    return json;
}

Json errorJson(const SettingResult& result, const Json& truth) {
    if (!result.errors) return nullptr;
    Json json = truth;
    json.update(figuresJson(*result.errors));
    json["flicker"] = result.flicker ? Json(*result.flicker) : Json();
    return json;
}

Json framesJson(const SettingResult& result) {
    Json frames = Json::array();
    for (const FrameResult& frame : result.frames) {
        const bool timed = !frame.milliseconds.empty();
        frames.push_back({{"frame", frames.size()},
                          {"seconds", frame.seconds},
                          {"ms", timed ? Json(median(frame.milliseconds)) : Json()},
                          {"cost", timed ? Json(median(frame.costs)) : Json()},
                          {"standard_error", frame.standardError}});
        frames.back().update(figuresJson(*frame.errors));
    }
    return frames;
}

Json parametersJson(const Setting& setting) {
    Json json = Json::object();
    for (const Parameter* parameter : setting.parameters().all())
        if (setting.tells(*parameter)) json[std::string(parameter->spec().id)] = jsonOf(*parameter, parameter->value());
    return json;
}

Json resultJson(const SettingResult& result, const Json& truth, bool motion) {
    Json json = {{"row", result.setting.place},
                 {"technique", result.setting.card->id},
                 {"parameters", parametersJson(result.setting)},
                 {"ms", nullptr},
                 {"cost", nullptr},
                 {"stages", Json::object()},
                 {"passes", Json::array()}};
    if (!result.milliseconds.empty()) {
        const TimeSummary frame = summarise(result.milliseconds);
        json["ms"] = {{"median", frame.median}, {"p95", frame.p95}, {"min", frame.min}};
        json["cost"] = intervalJson(summarise(result.costs));
        json["timed_frames"] = frame.count;
        for (size_t stage = 0; stage < result.stages.size(); ++stage)
            if (!result.stages[stage].empty())
                json["stages"][std::string(stageName(static_cast<Stage>(stage)))] = median(result.stages[stage]);
        for (const PassTimes& pass : result.passes)
            json["passes"].push_back(
                {{"stage", stageName(pass.stage)}, {"label", pass.label}, {"ms", median(pass.milliseconds)}});
    }
    json["bytes"] = result.bytes;
    json["maps"] = result.maps;
    json["pass_count"] = result.costPasses;
    json["reads"] = readsJson(*result.setting.technique);
    json["error"] = errorJson(result, truth);
    json["frames"] = framesJson(result);
    json["front"] = false;
    if (motion && result.frames.size() > eventFrame) {
        std::vector<double> since;
        for (size_t i = eventFrame; i < result.frames.size(); ++i)
            since.push_back(result.frames[i].errors->penumbra.rmse);
        const Ghost ghost = ghostOf(since);
        json["ghost"] = {{"peak", ghost.peak},
                         {"settled", ghost.settled},
                         {"half_life", ghost.halfLife ? Json(*ghost.halfLife) : Json()}};
    }
    if (!result.trouble.empty()) json["trouble"] = result.trouble;
    return json;
}

// Cost over that of the first row, from rounds that both were in.
void addRatios(const Measurement& measurement, Json& results) {
    const auto& rows = measurement.results;
    for (size_t i = 1; i < rows.size(); ++i) {
        const size_t rounds = std::min(rows[0].costs.size(), rows[i].costs.size());
        if (rounds == 0) continue;
        const Ratio ratio = medianRatio({rows[i].costs.data(), rounds}, {rows[0].costs.data(), rounds});
        results[i]["cost_over_first"] = {{"median", ratio.median},
                                         {"low", ratio.interval.low},
                                         {"high", ratio.interval.high},
                                         {"differs", ratio.differs()}};
    }
}

// Of all that decides what is seen and where its shadows fall. Not of the driver.
uint64_t viewHash(const Session& session, const MeasurementPlan& plan) {
    const Scene& scene = *session.scene;
    Hash hash;
    const auto addVector = [&](const auto& v) { hash.addBytes(&v, sizeof(v)); };
    const auto addCamera = [&](const Camera& camera) {
        addVector(camera.eye);
        addVector(camera.target);
        addVector(camera.up);
        hash.add(camera.fovY);
    };
    Pose pose;
    evaluatePose(scene, session.clip, session.time, pose);
    hash.addBytes(scene.positions.data(), scene.positions.size() * sizeof(scene.positions[0]));
    hash.add(scene.indices);
    for (const TextureImage& texture : scene.textures) hash.add(texture.rgba);
    for (const glm::mat4& matrix : pose.worldFromNode) addVector(matrix);
    hash.add(pose.morphWeights);
    addCamera(session.camera);
    hash.add(session.light.shape);
    addVector(session.light.position);
    addVector(session.light.target);
    addVector(session.light.size);
    hash.add(session.ground);
    hash.add(session.time);
    hash.add(session.timeStep);
    hash.add(session.seed);
    addVector(session.size);
    if (plan.motion) hash.add(*plan.motion);
    if (plan.path)
        for (int frame = 0; frame < plan.frames; ++frame) addCamera(plan.path->at(frame));
    return hash.value();
}

Json viewJson(const Options& options, const Session& session, const MeasurementPlan& plan) {
    const Json facts = factsOf(session, Shot(), "");
    Json view = {{"name", options.view ? Json(*options.view) : Json()}};
    for (const char* fact : {"camera", "light", "further-lights", "ground", "time", "time-step", "seed"})
        view[fact] = facts.at(fact);
    view["path"] = options.path ? Json(*options.path) : Json();
    view["motion"] = options.motion ? Json(*options.motion) : Json();
    view["hash"] = fmt::format("{:016x}", viewHash(session, plan));
    return view;
}

void print(const Options& options, const Json& document) {
    if (options.json)
        fmt::print("{}\n", document.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        fmt::print("{}", options.csv ? measurementCsv(document) : measurementTable(document));
}

constexpr int defaultMaps = 256;

// `cache` lives as long as the plan is carried out.
void chooseTruth(MeasurementPlan& plan, const Options& options, TruthCache& cache) {
    static constexpr std::string_view names[] = {"ray", "samples"};
    const std::string_view name = options.against ? std::string_view(*options.against) : names[0];
    if (std::find(std::begin(names), std::end(names), name) == std::end(names))
        throw InputError(
            fmt::format("--against: '{}' is not one of {}{}", name, fmt::join(names, ", "), suggestion(name, names)));
    if (name == "samples") {
        plan.truth = sampledTruth(options.samples.value_or(defaultMaps));
        return;
    }
    TruthSettings settings;
    settings.cache = &cache;
    if (options.samples) settings.leastSamples = settings.mostSamples = *options.samples;
    plan.truth = tracedTruth(settings);
    plan.biasMaps = defaultMaps;
}

// What all measurements tell first.
Json heading(const Renderer& renderer, const Options& options, const Session& session, const MeasurementPlan& plan,
             bool timed = true) {
    std::vector<std::string> doubts;
    if (timed) doubts = doubtsAboutTimes(renderer, false);
    for (const std::string& doubt : doubts) fmt::print(stderr, "note: {}\n", doubt);
    return {{"program", "penumbra"},
            {"version", PENUMBRA_VERSION},
            {"driver", renderer.driver()},
            {"scene", session.scene->name},
            {"size", {session.size.x, session.size.y}},
            {"view", viewJson(options, session, plan)},
            {"frames", plan.frames},
            {"repeat", plan.repeats},
            {"notes", doubts}};
}

void addResults(Json& document, const Options& options, const Measurement& measurement) {
    const Json truth = {{"against", options.against.value_or("ray")},
                        {"samples", measurement.truthSamples},
                        {"standard_error", measurement.truthStandardError},
                        {"map_bias", measurement.mapBias ? Json(*measurement.mapBias) : Json()}};
    document["complete"] = measurement.complete;
    document["results"] = Json::array();
    for (const SettingResult& result : measurement.results)
        document["results"].push_back(resultJson(result, truth, options.motion.has_value()));
}

int finish(const HeadlessContext& context, bool complete, size_t done, size_t rows) {
    for (const std::string& message : context.messages()) fmt::print(stderr, "note: OpenGL: {}\n", message);
    if (complete) return 0;
    fmt::print(stderr, "penumbra: interrupted; {} of {} rows are kept\n", done, rows);
    return 1;
}

// Refuses options that mean nothing together with `name`.
void refuseTogether(const char* name, std::initializer_list<std::pair<const char*, bool>> strangers) {
    for (const auto& [stranger, given] : strangers)
        if (given) throw InputError(fmt::format("{} and {}: one of them was expected", name, stranger));
}

// --- a budget ------------------------------------------------------------------------------------------------------

// What the options ask to be searched for, if they do.
std::optional<Budget> budgetOf(const Options& options) {
    const char* name = options.budgetMs ? "--budget-ms" : "--budget-rmse";
    if (!options.budgetMs && !options.budgetRmse) {
        if (options.free) throw InputError("--free: --budget-ms or --budget-rmse was expected with it");
        return std::nullopt;
    }
    if (options.budgetMs && options.budgetRmse)
        throw InputError("--budget-ms and --budget-rmse: one of them was expected");
    if (!options.free) throw InputError(fmt::format("{}: --free NAME,... was expected with it", name));
    refuseTogether(name, {{"--sweep", !options.sweeps.empty()},
                          {"--path", options.path.has_value()},
                          {"--motion", options.motion.has_value()},
                          {"--shard", options.shard.has_value()},
                          {"--merge", !options.merged.empty()},
                          {"--frames", options.frames.has_value()},
                          {"--repeat", options.repeat.has_value()},
                          {"--play", options.play}});
    const std::string& text = options.budgetMs ? *options.budgetMs : *options.budgetRmse;
    Budget budget{options.budgetMs ? Bound::Cost : Bound::Error, 0};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), budget.limit);
    if (error != std::errc() || end != text.data() + text.size() || !(budget.limit > 0 && budget.limit < 1e9))
        throw InputError(fmt::format("{}: '{}' is not a number above 0", name, text));
    return budget;
}

int searchBudget(const Options& options, const Budget& budget) {
    const std::vector<Setting> starts = combinations(options);
    const std::vector<FreeParameter> free = parseFree(*options.free);
    const size_t expected = checkFree(starts, free);
    Options others = options;
    others.technique = others.preset = std::nullopt;
    others.assignments.clear();
    std::vector<std::optional<std::string>> names{options.view};
    if (options.view) {
        const std::vector<std::string> list = commaList(*options.view);
        names.assign(list.begin(), list.end());
    }
    std::vector<Session> sessions;
    for (const auto& name : names) {
        others.view = name;
        Shot shot;
        sessions.push_back(makeSession(others, shot));
    }
    MeasurementPlan plan;
    TruthFiles cache;
    chooseTruth(plan, options, cache);
    plan.biasMaps = 0;

    const HeadlessContext context;
    Json document, views = Json::array();
    {
        const Renderer renderer;
        others.view = names[0];
        document = heading(renderer, others, sessions[0], plan);
        for (size_t i = 0; i < names.size(); ++i) {
            others.view = names[i];
            views.push_back(viewJson(others, sessions[i], plan));
        }
    }
    Measurement measurement;
    BudgetSearch search;
    {
        ProgressLine line;
        std::vector<Measurer> measurers;
        for (Session& session : sessions) measurers.emplace_back(std::move(session), plan, line.progress());
        const Evaluate evaluate = measuredIn(measurers, expected, [&](SettingResult result) {
            const size_t place = result.setting.place;
            if (place >= measurement.results.size()) return measurement.results.push_back(std::move(result));
            measurement.results[place] = std::move(result);
        });
        search = penumbra::searchBudget(starts, free, budget, evaluate);
        for (const Measurer& measurer : measurers) measurer.tellTruth(measurement);
    }
    measurement.complete = search.complete;
    addResults(document, options, measurement);
    for (size_t i = 0; i < measurement.results.size(); ++i) document["results"][i]["proposal"] = search.proposal == i;
    document["frames"] = nullptr; // "timed_frames" of each
    document["budget"] = {{"bound", budget.bound == Bound::Cost ? "cost" : "rmse"},
                          {"limit", budget.limit},
                          {"free", *options.free},
                          {"views", views},
                          {"tried", search.trials.size()},
                          {"proposal", search.proposal ? Json(*search.proposal) : Json()},
                          {"certain", search.proposal ? Json(search.certain) : Json()}};
    markFront(document);
    print(options, document);
    return finish(context, measurement.complete, measurement.results.size(), expected);
}

// --- the error of the irradiance -----------------------------------------------------------------------------------

bool wantsIrradiance(const Options& options) {
    static constexpr std::string_view names[] = {"truth", "irradiance"};
    const std::string_view name = options.error ? std::string_view(*options.error) : names[0];
    if (std::find(std::begin(names), std::end(names), name) == std::end(names))
        throw InputError(
            fmt::format("--error: '{}' is not one of {}{}", name, fmt::join(names, ", "), suggestion(name, names)));
    if (name == "truth") return false;
    refuseTogether("--error irradiance", {{"--against", options.against.has_value()},
                                          {"--samples", options.samples.has_value()},
                                          {"--budget-ms", options.budgetMs.has_value()},
                                          {"--budget-rmse", options.budgetRmse.has_value()},
                                          {"--free", options.free.has_value()},
                                          {"--path", options.path.has_value()},
                                          {"--motion", options.motion.has_value()},
                                          {"--frames", options.frames.has_value()},
                                          {"--repeat", options.repeat.has_value()},
                                          {"--play", options.play}});
    return true;
}

Json irradianceJson(const IrradianceResult& result) {
    Json json = {{"row", result.setting.place},
                 {"technique", result.setting.card->id},
                 {"parameters", parametersJson(result.setting)},
                 {"error", nullptr}};
    if (result.errors) {
        const IrradianceErrors& e = *result.errors;
        json["error"] = {{"against", irradianceReference},
                         {"mean_abs", e.mean},
                         {"bias", e.bias},
                         {"above", e.above},
                         {"shadowed", e.shadowed},
                         {"surfaces", e.surfaces},
                         {"layers", e.layers},
                         {"last_layer", e.lastLayer}};
    }
    if (!result.trouble.empty()) json["trouble"] = result.trouble;
    return json;
}

int measureIrradiance(const Options& options, Session session, std::vector<Setting> settings) {
    const size_t rows = settings.size();
    const HeadlessContext context;
    Json document = heading(Renderer(), options, session, {}, false);
    document["metric"] = "irradiance";
    IrradianceMeasurement measurement;
    {
        ProgressLine line;
        measurement = penumbra::measureIrradiance(std::move(session), std::move(settings), line.progress());
    }
    document["complete"] = measurement.complete;
    document["results"] = Json::array();
    for (const IrradianceResult& result : measurement.results) document["results"].push_back(irradianceJson(result));
    print(options, document);
    return finish(context, measurement.complete, measurement.results.size(), rows);
}

} // namespace

int measure(const Options& options) {
    if (options.json && options.csv) throw InputError("--json and --csv: one of them was expected");
    const bool irradiance = wantsIrradiance(options);
    if (const std::optional<Budget> budget = budgetOf(options)) return searchBudget(options, *budget);
    if (!options.merged.empty()) {
        print(options, mergeMeasurements(options.merged));
        return 0;
    }
    std::vector<Setting> settings = combinations(options);
    const size_t rows = settings.size();
    Options others = options; // what has to do with settings is known
    others.technique = others.preset = std::nullopt;
    others.assignments.clear();
    Shot shot;
    Session session = makeSession(others, shot);
    if (irradiance) return measureIrradiance(options, std::move(session), std::move(settings));
    session.time -= (shot.frames - 1) * session.timeStep; // that of the first frame
    MeasurementPlan plan = makePlan(options, session);
    TruthFiles cache;
    chooseTruth(plan, options, cache);

    const HeadlessContext context;
    Json document = heading(Renderer(), options, session, plan);
    Measurement measurement;
    {
        ProgressLine line;
        measurement = penumbra::measure(std::move(session), std::move(settings), plan, line.progress());
    }
    addResults(document, options, measurement);
    addRatios(measurement, document["results"]);
    markFront(document);
    print(options, document);
    return finish(context, measurement.complete, measurement.results.size(), rows);
}

} // namespace penumbra
