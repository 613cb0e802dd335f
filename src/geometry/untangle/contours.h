// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/untangle/collision_mesh.h"

namespace arris {

/// An edge that passes through the interior of a face, by exact predicates.
struct Piercing {
    int edge, face;
    double along;                   ///< of the edge, from a to b, at which it meets the face
    std::array<double, 3> weights;  ///< of the meeting point on the face

    auto key() const { return std::array{edge, face}; }
};

/// A connected set of pairs of faces that cross or touch: where two *sheets*, parts of the surface, meet.
/// Neighbours in the set have one face in common, and edge neighbours as the others.
struct Contour {
    std::vector<std::array<int, 2>> pairs;  ///< a face of sheet 0 first
    /// Edges of each sheet that pierce the other one. None in either: the sheets touch or lie on each other.
    std::array<std::vector<Piercing>, 2> piercings;
    double length = 0.0;  ///< m
    /// Derivative of the length as sheet 0 moves as a whole against sheet 1: the sum along the contour of the
    /// directions of Volino and Magnenat-Thalmann 2006.
    Vec3 pull = Vec3::Zero();

    bool is_pierced() const { return !piercings[0].empty() || !piercings[1].empty(); }
    /// The faces on a sheet that cross the other one, ascending.
    std::vector<int> faces(int sheet) const;
};

/// Pairs of faces that cross or touch, the lesser face first, ascending. By the rule of their surfaces; those
/// of rule Ignore are left out.
struct Crossings {
    std::vector<std::array<int, 2>> to_untangle, kept;
};
Crossings find_crossings(const CollisionMesh& mesh, const std::vector<Vec3>& positions);

/// The contours of all `pairs`, by their first pair.
std::vector<Contour> find_contours(const CollisionMesh& mesh, const std::vector<std::array<int, 2>>& pairs);

}  // namespace arris
