// SPDX-License-Identifier: MIT
// How often which value occurs, and the range that is shown, with two ends to drag.
#pragma once

#include "renderer/inspect/inspector.h"
#include "ui/widgets.h"

namespace penumbra {

class Histogram {
public:
    // As wide as the region. `look` colours the bar below, which a small picture of the domain passes through. True
    // while `range` is dragged.
    bool draw(Inspector& inspector, const Statistics& statistics, const Look& look, std::span<const Channel> channels,
              ValueRange& range);

private:
    enum class Grab { None, Low, High, Both };
    void paintBar(Inspector& inspector, ValueRange domain, const Look& look, std::span<const Channel> channels);

    Grab grab_ = Grab::None;
    Texture ramp_, bar_; // the domain's values from left to right, and their colours
    ValueRange rampDomain_;
    Look barLook_;
    const Channel* barChannels_ = nullptr;
};

} // namespace penumbra
