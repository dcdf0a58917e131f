// SPDX-License-Identifier: MIT
#include "renderer/truth/sampled_truth.h"

#include "renderer/core/hash.h"
#include "renderer/renderer.h"
#include "renderer/truth/tracer.h"

#include <chrono>
#include <cmath>

namespace penumbra {
namespace {

// Puts a session back as it was, whatever happens.
class Restored {
public:
    explicit Restored(Session& session)
        : session_(session)
        , chosen_(session.techniques.card().id)
        , show_(session.display.show)
        , progressive_(session.progressive) {
        for (const Parameter* p : set().all())
            values_.push_back(p->changed() ? std::optional(p->value()) : std::nullopt);
    }
    ~Restored() {
        for (size_t i = 0; i < values_.size(); ++i)
            values_[i] ? set().all()[i]->set(*values_[i]) : set().all()[i]->reset();
        session_.techniques.choose(chosen_);
        session_.display.show = show_;
        session_.progressive = progressive_;
    }
    Restored(const Restored&) = delete;

private:
    ParameterSet& set() const { return session_.techniques.parametersOf("light-sampling"); }
    Session& session_;
    std::string_view chosen_;
    Show show_;
    bool progressive_;
    std::vector<std::optional<double>> values_;
};

} // namespace

Truth sampledTruth(Renderer& renderer, Session& session, const SamplingSettings& settings) {
    const auto start = std::chrono::steady_clock::now();
    const Restored restored(session);
    ParameterSet& set = session.techniques.parametersOf("light-sampling");
    set.reset();
    set.at("samples").set(settings.maps);
    set.at("map-size").set(settings.mapSize);
    session.techniques.choose("light-sampling");
    session.display.show = Show::Shadow;
    session.progressive = false;
    renderer.reset();
    renderer.render(session);

    const TruthInput input = readTruthInput(renderer, session);
    Truth truth{.width = input.view.size.x, .height = input.view.size.y};
    truth.psi = renderer.read(renderer.shadow()).values;
    truth.standardError.resize(truth.psi.size());
    truth.classes = classesOf(input);
    for (size_t i = 0; i < truth.psi.size(); ++i) truth.penumbraPixels += truth.isPenumbra(i) ? 1 : 0;
    truth.samplesLeast = truth.samplesMost = settings.maps;
    truth.samplesMean = settings.maps;
    truth.complete = true;
    truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    renderer.reset();
    return truth;
}

double mapBias(const Truth& traced, const Truth& sampled) {
    ensure(traced.psi.size() == sampled.psi.size(), "truths of different views are compared");
    double squares = 0, pixels = 0;
    for (size_t i = 0; i < traced.psi.size(); ++i) {
        if (traced.classes[i] != PixelClass::FacesWholeLight) continue;
        const double difference = static_cast<double>(sampled.psi[i]) - traced.psi[i];
        squares += difference * difference;
        ++pixels;
    }
    return pixels > 0 ? std::sqrt(squares / pixels) : 0;
}

} // namespace penumbra
