// SPDX-License-Identifier: MIT
// Hamburger four-moment shadow mapping (Peters and Klein, i3D 2015): a map of the first four powers of the depth,
// filtered; of all distributions of depth that have the four filtered moments, wherever on the real line, the one that
// puts least in front of the fragment is ψ, in closed form (algorithm 3).
//
// Two surfaces within a kernel are reconstructed exactly but for the bias; more make shadows too light, never too dark.
#include "renderer/techniques/four_moments.h"

namespace penumbra {

extern const Card msmHamburgerCard;
const Card msmHamburgerCard{
    .id = "msm-hamburger",
    .title = "Moment shadow mapping",
    .authors = "Peters, Klein",
    .year = 2015,
    .venue = "i3D",
    .idea = "Filter the first four powers of the depth; of all depths that have these four means, take those that cast "
            "the least shadow.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. At most "
               "two surfaces within the kernel.",
    .fails =
        "Three and more surfaces within the kernel leak light, and so do contacts, by the moment bias that rounding "
        "needs; with less bias lit surfaces speckle.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new FourMoments("techniques/msm_hamburger.glsl", planeBias)); },
};

} // namespace penumbra
