// SPDX-License-Identifier: MIT
// The average irradiance error of Peters and Klein 2015, section 3.2: how far ψ of a setting is from that of
// percentage-closer filtering with the same kernel, over all surfaces that face a directional light. Such a surface
// receives power in proportion to the area that it covers on the shadow map, so the mean over every surface behind
// every texel, layer by layer, is the error of the irradiance as a share of all the power that the light sends.
#pragma once

#include "renderer/measure/combinations.h"
#include "renderer/renderer.h"

#include <optional>
#include <string_view>

namespace penumbra {

// The technique that errors are against, with a kernel as wide.
inline constexpr std::string_view irradianceReference = "pcf";

struct IrradianceErrors {
    double mean = 0;     // |ψ − F|
    double bias = 0;     // ψ − F; of a lower bound minus the mean
    double above = 0;    // max(ψ − F, 0): what no bound may have, but for its biases
    double shadowed = 0; // F: the share of the power that is shadowed
    size_t surfaces = 0; // texels, of all layers
    int layers = 0;
    double lastLayer = 0; // share of the surfaces that are in the last of mostLightLayers; what is behind is not seen
};

struct IrradianceResult {
    Setting setting;
    std::optional<IrradianceErrors> errors;
    std::string trouble; // why there are none
};

struct IrradianceMeasurement {
    std::vector<IrradianceResult> results;
    bool complete = true; // false: it was cancelled
};

// Draws in the current context. The light counts as a directional one without a size. The reference is a Gaussian of
// the setting's own kernel, σ and map, or 9x9, 2.4 and 1024 where it has none.
IrradianceMeasurement measureIrradiance(Session session, std::vector<Setting> settings, Progress& progress);

} // namespace penumbra
