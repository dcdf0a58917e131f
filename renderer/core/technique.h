// SPDX-License-Identifier: MIT
// What a shadow technique is: a title card, a list of parameters, and build(), which appends passes to a flow and
// returns the shadow image ψ. A technique is one .cpp below renderer/techniques without a header, one shader file, and
// one line of catalogue.cpp.
#pragma once

#include "renderer/core/flow.h"
#include "renderer/core/probe.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace penumbra {

struct Inputs; // view, light, geometry buffer, scene: renderer/inputs.h

struct Card;

// Texels that a pixel reads of shadow maps and of what is made of them; a gather reads four. Of pixels that face the
// light, which others need not ask.
struct TextureReads {
    int least = 0, most = 0;
};

class Technique {
public:
    virtual ~Technique() = default;
    virtual ParameterSet& parameters() = 0;
    // With these parameters, in a frame that is drawn at once; nothing: it is not known.
    virtual std::optional<TextureReads> readsPerPixel() const { return std::nullopt; }
    // How many pixels it wants of the geometry buffer beyond each edge of a picture of that size.
    virtual glm::ivec2 margin(glm::ivec2 /*pictureSize*/) const { return {0, 0}; }
    // Appends passes and returns ψ(x, y) in [0, 1], the fraction of the light that a pixel's surface does not see:
    // one R32F image of the picture's size named "shadow". Pixels without a surface are 0.
    virtual Image build(Flow& flow, Scope scope, const Inputs& inputs) const = 0;
    // What it has to tell of one pixel, from images that are there while somebody looks into them.
    virtual std::span<const ProbePlot> probePlots() const { return {}; }
};

// The title card: who, when, what, and what it cannot do. It feeds the picker, `penumbra list` and the docs.
struct Card {
    std::string_view id; // lower case, hyphens; never changes once published
    std::string_view title;
    std::string_view authors;
    int year = 0;
    std::string_view venue;
    std::string_view idea;
    std::string_view assumes;
    std::string_view fails; // known failures
    // What the contract tests allow at defaults: the mean of ψ on an empty lit floor, and 1 − ψ under a closed lid.
    double litTolerance = 0, lidTolerance = 0;
    std::unique_ptr<Technique> (*make)() = nullptr;
};

// The techniques in the order of the picker; renderer/techniques/catalogue.cpp.
std::span<const Card* const> catalogue();
// Throws InputError with the nearest id.
const Card& findCard(std::string_view id);
// A new technique with its parameters at their defaults, owner set.
std::unique_ptr<Technique> makeTechnique(const Card& card);

// The ψ image's channel, the same for all techniques.
std::span<const Channel> shadowChannels();

} // namespace penumbra
