// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// A point of an obstacle's features on which a cloth face may rest: a corner, or a node at which a polyline
/// bends, however little.
struct FeatureNode {
    int point;                      ///< index in the mesh
    bool is_corner = false;         ///< otherwise a node between two edges
    std::array<int, 2> neighbours;  ///< points at the other ends of the two edges
    std::array<Vec3, 2> away;       ///< unit directions to those points
};

/// Index in features().corners of a point of the mesh; -1 where the point is no corner.
int corner_at(const ObstacleFeatures& features, int point);
bool is_corner(const ObstacleFeatures& features, int point);

/// Whether a corner (index in features().corners) has no face: a nail, an end of a wire, or a point where
/// wires meet or bend sharply. Cloth on such a corner is a cone around it.
bool is_tip(const Obstacle& obstacle, int corner);

/// Sorted ascending by point. Linear in the number of features, apart from a sort.
std::vector<FeatureNode> find_feature_nodes(const Obstacle& obstacle);

}  // namespace arris
