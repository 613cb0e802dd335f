// SPDX-License-Identifier: GPL-3.0-or-later
//
//         *       wire      Where a wire turns between two vertices of a trace their
//       /   \               chord passes by the turn. The cloth folds over the chord,
//     p-------q   chord     and the turn presses through its face beside that. Put
//                           there while the cloth is flat, a vertex changes nothing;
//                           in folded cloth it would have to move the fold.
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/feature_path.h"
#include "solver/sites/feature_sites.h"

namespace arris {

/// Whether a vertex at this turn is held there: where a chord over a cell of the cloth at `material` misses
/// it by more than .3 of a thickness. A trace of vertices that slide follows a wire of shorter edges as well
/// as its cells can, and vertices held nearer to each other than cells are would hold the cloth.
bool locks_at_bend(const Scene& scene, const Obstacle& obstacle, const FeatureBend& bend,
                   const Vec2& material);

/// Where obstacle `o` turns, in a face, on an edge or at a vertex of the cloth: `vertices`, -1 where there
/// are fewer, with their `weights`.
FeatureSite make_bend_site(const State& state, const ClothStars& stars, std::int32_t o,
                           const FeatureBend& bend, const std::array<int, 3>& vertices,
                           const std::array<double, 3>& weights, const Vec3& outward);

/// Turns of wires between neighbours along a trace, these being EOL vertices or `sites`, that their chord
/// misses by more than .3 of a thickness, where vertices are held and the cloth is near enough to be put on
/// them: of each pair the one that it misses most. `positions`: the cloth's in the frame of obstacle `o`.
/// None that has a vertex or site already.
std::vector<FeatureSite> find_bend_sites(const Scene& scene, const State& state, const ClothStars& stars,
                                         std::int32_t o, const std::vector<Vec3>& positions,
                                         const std::vector<FeatureSite>& sites);

}  // namespace arris
