// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/feature_sites.h"

namespace arris {

/// Flow, m/s, of the material through a future EOL vertex at a site, against the motion over the obstacle of
/// the cloth around `site.near`. The mean over the faces, so that the flow of cloth sliding over an edge
/// agrees with the cloth on both sides. A vertex that slides along its feature moves with the cloth in that
/// direction. Material flows through it only across its trace, or on the cloth's border along the border,
/// with equal flow across. Zero where the faces do not determine the flow.
Vec2 find_feature_flow(const Scene& scene, const State& state, const ClothStars& stars,
                       const FeatureSite& site);

}  // namespace arris
