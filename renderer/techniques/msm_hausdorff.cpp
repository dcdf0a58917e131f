// SPDX-License-Identifier: MIT
// Hausdorff four-moment shadow mapping (Peters and Klein, i3D 2015): the map of msm-hamburger, and of all distributions
// with the four filtered moments whose depths lie in the map's range the one that puts least in front of the fragment.
// Knowing the range makes contact shadows darker: a single surface is reconstructed exactly in spite of the bias.
#include "renderer/techniques/four_moments.h"

namespace penumbra {

extern const Card msmHausdorffCard;
const Card msmHausdorffCard{
    .id = "msm-hausdorff",
    .title = "Moment shadow mapping, bounded depth",
    .authors = "Peters, Klein",
    .year = 2015,
    .venue = "i3D",
    .idea = "Moment shadow mapping that also knows that all depths lie within the map's range.",
    .assumes = "A penumbra of one width everywhere, whatever the light's size and the distance of what casts. At most "
               "two surfaces within the kernel.",
    .fails =
        "Three and more surfaces within the kernel leak light. What 16 bits round away shows as noise at contacts.",
    .litTolerance = 1e-4,
    .lidTolerance = 1e-3,
    .make = [] { return std::unique_ptr<Technique>(new FourMoments("techniques/msm_hausdorff.glsl", steeperBias)); },
};

} // namespace penumbra
