// SPDX-License-Identifier: MIT
// The one ordered list of techniques. A new one is a line here, a .cpp beside this file and a shader.
#include "renderer/core/technique.h"

#include <fmt/format.h>

#include <algorithm>

#define TECHNIQUES(X)                                                                                                  \
    X(none)                                                                                                            \
    X(hard)                                                                                                            \
    X(pcf)                                                                                                             \
    X(pcss)                                                                                                            \
    X(lightSampling)                                                                                                   \
    X(temporal)                                                                                                        \
    X(vsm)                                                                                                             \
    X(esm)                                                                                                             \
    X(evsm)                                                                                                            \
    X(convolution)                                                                                                     \
    X(lvsm)                                                                                                            \
    X(msmHamburger)                                                                                                    \
    X(msmHausdorff)                                                                                                    \
    X(msmTrigonometric)                                                                                                \
    X(msmSix)                                                                                                          \
    X(vsmSoft)                                                                                                         \
    X(msmSoft)                                                                                                         \
    X(fractionalDisk)

namespace penumbra {

#define DECLARE(name) extern const Card name##Card;
TECHNIQUES(DECLARE)
#undef DECLARE

std::span<const Card* const> catalogue() {
#define ADDRESS(name) &name##Card,
    static constexpr const Card* cards[] = {TECHNIQUES(ADDRESS)};
#undef ADDRESS
    return cards;
}

const Card& findCard(std::string_view id) {
    const auto cards = catalogue();
    const auto found = std::find_if(cards.begin(), cards.end(), [&](const Card* card) { return card->id == id; });
    if (found != cards.end()) return **found;
    std::vector<std::string_view> ids;
    for (const Card* card : cards) ids.push_back(card->id);
    throw InputError(fmt::format("there is no technique '{}'{}", id, suggestion(id, ids)));
}

std::unique_ptr<Technique> makeTechnique(const Card& card) {
    std::unique_ptr<Technique> technique = card.make();
    technique->parameters().setOwner(card.id);
    return technique;
}

std::span<const Channel> shadowChannels() {
    static constexpr Channel channels[] = {
        {"psi", "ψ", "share of the light that the surface does not see; 0: lit, 1: in full shadow", Unit::None, 0, 1}};
    return channels;
}

} // namespace penumbra
