// SPDX-License-Identifier: MIT
// One row per parameter of a set, made from its declaration alone.
#pragma once

#include "ui/widgets.h"

#include "renderer/core/parameters.h"

#include <optional>

namespace penumbra {

class ParameterPanel {
public:
    void draw(ParameterSet& set);

private:
    void group(ParameterSet& set, std::string_view title);
    void parameterRow(Parameter& parameter);
    void control(Parameter& parameter);
    void slider(Parameter& parameter);
    void typeIn(Parameter& parameter);

    const Parameter* typed_ = nullptr; // whose value is being typed
    bool focusTyped_ = false;
    TextField<64> typing_;
    const Parameter* pressed_ = nullptr; // whose slider was clicked last, and its value then; none: the default
    std::optional<double> beforePress_;
    const Parameter* refused_ = nullptr; // whose typed value was refused, and why
    std::string refusal_;
};

} // namespace penumbra
