// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A place of the cloth on which a feature presses.
struct FeatureSite {
    FeatureId on;
    Vec2 material;
    VertexId near;                       ///< a vertex of the cloth's element
    Vec3 outward;                        ///< the contact's normal, in the obstacle's frame
    bool is_on_border = false;           ///< of the cloth
    std::array<int, 2> edge = {-1, -1};  ///< edge of the cloth there; twice the same vertex at a vertex
    int contact = -1;                    ///< index in State::active; -1 where it only fills a gap
    bool is_on_fold = false;             ///< of cloth around a wire or border; may be off the feature

    /// Whether the site is in a face, at a bend of a rim.
    bool is_in_face() const { return !on.is_fixed() && edge[0] < 0; }
};

/// Place of a site on an edge of the cloth, of the frame of `positions`, which are the cloth's.
Vec3 place_of_site(const ClothMesh& mesh, const ClothStars& stars, const FeatureSite& site,
                   const std::vector<Vec3>& positions);

/// Places where features pressed at the end of the last step and no EOL vertex is yet: corners first, then
/// bends. Sites of one feature are in the order of their material coordinates. On a convex edge a site is
/// where the cloth crosses the plane in which an EOL vertex may move, so that inserting one moves no cloth.
/// Trace gaps between sites are included, as they would hold the cloth. On a wire, so are the bends that a
/// trace would miss (bend_sites.h).
std::vector<FeatureSite> find_feature_sites(const Scene& scene, const State& state, const ClothStars& stars);

}  // namespace arris
