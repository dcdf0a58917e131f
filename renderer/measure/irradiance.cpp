// SPDX-License-Identifier: MIT
#include "renderer/measure/irradiance.h"

#include "renderer/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

struct Filter {
    int kernel = 9;
    double sigma = 2.4;
    int mapSize = 1024;
    bool operator==(const Filter&) const = default;
};

Filter filterOf(const ParameterSet& values) {
    Filter filter;
    if (const Parameter* size = values.find("map-size")) filter.mapSize = static_cast<int>(size->value());
    const Parameter *kernel = values.find("kernel"), *sigma = values.find("sigma");
    if (!kernel || !sigma) return filter;
    filter.kernel = static_cast<int>(kernel->value());
    filter.sigma = sigma->value();
    return filter;
}

constexpr float noSurface = -1;

// ψ of percentage-closer filtering, layer by layer.
struct Reference {
    Filter filter;
    std::vector<std::vector<float>> shadow; // noSurface where there is none
};

class LightSide {
public:
    explicit LightSide(Session session) : session_(std::move(session)) {
        changeShape(session_.light, LightShape::Directional);
        session_.light.size = {0, 0};
        session_.timeStep = 0;
        session_.frame = 0;
        session_.progressive = false;
    }

    IrradianceErrors errorsOf(const ParameterSet& values) {
        const Filter filter = filterOf(values);
        if (!reference_ || reference_->filter != filter) reference_ = draw(filter);
        session_.techniques.take(values);
        const std::vector<LightLayer> drawn =
            renderer_.renderFromLight(session_, filter.mapSize, static_cast<int>(reference_->shadow.size()));

        IrradianceErrors errors;
        errors.layers = static_cast<int>(drawn.size());
        size_t inLayer = 0;
        for (size_t layer = 0; layer < drawn.size(); ++layer) {
            const std::vector<float> psi = renderer_.read(drawn[layer].shadow).values;
            const std::vector<float>& shadow = reference_->shadow[layer];
            inLayer = 0;
            for (size_t i = 0; i < psi.size(); ++i) {
                if (shadow[i] == noSurface) continue;
                if (!std::isfinite(psi[i])) throw InputError("its shadow image is not finite");
                const double error = double{psi[i]} - double{shadow[i]};
                errors.mean += std::abs(error);
                errors.bias += error;
                errors.above += std::max(error, 0.0);
                errors.shadowed += shadow[i];
                ++inLayer;
            }
            errors.surfaces += inLayer;
        }
        if (errors.surfaces == 0) throw InputError("the light sees no surface that faces it");
        const auto surfaces = static_cast<double>(errors.surfaces);
        for (double* figure : {&errors.mean, &errors.bias, &errors.above, &errors.shadowed}) *figure /= surfaces;
        if (errors.layers == mostLightLayers) errors.lastLayer = static_cast<double>(inLayer) / surfaces;
        return errors;
    }

private:
    Reference draw(const Filter& filter) {
        session_.techniques.choose(irradianceReference);
        ParameterSet& parameters = session_.techniques.parameters();
        parameters.reset();
        parameters.at("shape").setText("gaussian");
        parameters.at("kernel").set(filter.kernel);
        parameters.at("sigma").set(filter.sigma);
        parameters.at("map-size").set(filter.mapSize);
        Reference reference{filter, {}};
        for (const LightLayer& layer : renderer_.renderFromLight(session_, filter.mapSize, mostLightLayers)) {
            std::vector<float> shadow = renderer_.read(layer.shadow).values;
            const std::vector<float> depth = renderer_.read(layer.depth).values;
            bool empty = true;
            for (size_t i = 0; i < shadow.size(); ++i) {
                if (depth[i] > 0)
                    empty = false;
                else
                    shadow[i] = noSurface;
            }
            if (empty) break;
            reference.shadow.push_back(std::move(shadow));
        }
        return reference;
    }

    Session session_;
    Renderer renderer_;
    std::optional<Reference> reference_;
};

} // namespace

IrradianceMeasurement measureIrradiance(Session session, std::vector<Setting> settings, Progress& progress) {
    LightSide light(std::move(session));
    IrradianceMeasurement measurement;
    const auto count = static_cast<double>(settings.size());
    try {
        for (Setting& setting : settings) {
            progress.report("comparing what the light sees", static_cast<double>(measurement.results.size()) / count);
            IrradianceResult result{std::move(setting), std::nullopt, {}};
            try {
                result.errors = light.errorsOf(result.setting.parameters());
            } catch (const InputError& error) {
                result.trouble = error.what();
            }
            measurement.results.push_back(std::move(result));
        }
    } catch (const Cancelled&) {
        measurement.complete = false;
    }
    return measurement;
}

} // namespace penumbra
