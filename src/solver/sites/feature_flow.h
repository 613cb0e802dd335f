// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/feature_sites.h"

namespace arris {

/// How fast, m/s, the material would flow through an EOL vertex at a site: against the motion of the cloth
/// around `site.near` over the obstacle. The mean over its faces, so that cloth which slides over an edge
/// flows as it does on either side. A vertex that slides along its feature goes with the cloth there:
/// material flows through it across its trace alone, or on the cloth's border along that, as much as across.
/// Zero where the faces tell nothing.
Vec2 find_feature_flow(const Scene& scene, const State& state, const ClothStars& stars,
                       const FeatureSite& site);

}  // namespace arris
