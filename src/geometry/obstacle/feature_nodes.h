// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// A point of an obstacle's features on which a cloth face may rest: a corner, or a node where a polyline
/// turns, be it little.
struct FeatureNode {
    int point;                      ///< in the mesh
    bool is_corner = false;         ///< else a node between two edges:
    std::array<int, 2> neighbours;  ///< the points at their other ends, and
    std::array<Vec3, 2> away;       ///< the unit directions to them
};

/// Index of a point of the mesh in features().corners; -1 where it is none.
int corner_at(const ObstacleFeatures& features, int point);
bool is_corner(const ObstacleFeatures& features, int point);

/// Whether a corner (index in features().corners) has no face: the tip of a nail, an end of a wire, or where
/// wires turn sharply or meet. Cloth on it is a cone around it.
bool is_tip(const Obstacle& obstacle, int corner);

/// Ascending by point. Linear in the features but for a sort.
std::vector<FeatureNode> find_feature_nodes(const Obstacle& obstacle);

}  // namespace arris
