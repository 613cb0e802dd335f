// SPDX-License-Identifier: GPL-3.0-or-later
//
//         *       wire      Where a wire bends between two vertices of a trace, their
//       /   \               chord passes by the bend. The cloth folds over the chord,
//     p-------q   chord     and the bend presses through its face beside the chord. In
//                           flat cloth, inserting a vertex at the bend changes nothing;
//                           in folded cloth the fold would have to move.
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/feature_path.h"
#include "solver/sites/feature_sites.h"

namespace arris {

/// Whether a vertex is locked at this bend: a chord over a cell of the cloth at `material` misses the bend by
/// more than 0.3 thicknesses. Sliding vertices can follow a wire of shorter edges as well as the cells allow.
/// Vertices locked nearer to each other than a cell would hold the cloth.
bool locks_at_bend(const Scene& scene, const State& state, const Obstacle& obstacle, const FeatureBend& bend,
                   const Vec2& material);

/// Site at a bend of obstacle `o`, in a face, on an edge or at a vertex of the cloth: `vertices`, -1 where
/// there are fewer, with their `weights`.
FeatureSite make_bend_site(const State& state, const ClothStars& stars, std::int32_t o,
                           const FeatureBend& bend, const std::array<int, 3>& vertices,
                           const std::array<double, 3>& weights, const Vec3& outward);

/// Sites at bends of wires between neighbours along a trace, which are EOL vertices or `sites`. The chord
/// misses the bend by more than 0.3 thicknesses, vertices are locked there, and the cloth is near enough. Of
/// each pair of neighbours only the bend missed most; none that has a vertex or site already. `positions`:
/// the cloth's in the frame of obstacle `o`.
std::vector<FeatureSite> find_bend_sites(const Scene& scene, const State& state, const ClothStars& stars,
                                         std::int32_t o, const std::vector<Vec3>& positions,
                                         const std::vector<FeatureSite>& sites);

}  // namespace arris
