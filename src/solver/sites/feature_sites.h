// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A place of the cloth that a feature presses on.
struct FeatureSite {
    FeatureId on;
    Vec2 material;
    VertexId near;                       ///< a vertex of the element that it is on
    Vec3 outward;                        ///< the contact's normal, in the obstacle's frame
    bool is_on_border = false;           ///< of the cloth
    std::array<int, 2> edge = {-1, -1};  ///< of the cloth that passes through there; twice the same: a vertex
    int contact = -1;                    ///< index in State::active; -1 where it only lies between such

    /// Whether it is in a face, where a rim bends.
    bool is_in_face() const { return !on.is_fixed() && edge[0] < 0; }
};

/// Where features pressed at the end of the last step and no EOL vertex is yet; corners first, then
/// turns, those of one feature in the order of the material. On a convex edge it is where the cloth passes
/// through the plane in which an EOL vertex may move, so that nothing has to be put there; and the places
/// between, as a trace with a hole holds the cloth there; on a wire the turns, too, that a trace would miss
/// (bend_sites.h).
std::vector<FeatureSite> find_feature_sites(const Scene& scene, const State& state, const ClothStars& stars);

}  // namespace arris
