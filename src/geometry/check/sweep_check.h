// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/contact/obstacle_contact.h"

namespace arris {

/// Result of checking a step's motion against an obstacle. Clean: by exact predicates, the cloth's surface is
/// free of the obstacle at the end, and no elements of the two met on the way.
struct SweepReport {
    /// Planes that would have prevented the meetings. Each has the cloth's point on its free side at begin,
    /// and is violated at the end. `least_gap` is the thickness, or the gap at begin where that was less
    /// (never the gap at the end).
    ///
    /// Each vertex and edge belongs to one cloth face. A face reports, for its own vertices and edges and
    /// itself, at most the 9 deepest violations; a vertex reports only what it met first. Sorted by (kind,
    /// vertices, element), without duplicates. May be empty where the cloth was not free at begin.
    std::vector<ObstacleContact> violations;
    /// Number of vertices that met a face, edges that met an edge or wire, and faces that met a point, each
    /// counted once. They may have passed through, stopped inside, come back or only touched. 0 where the
    /// step is clean; at least 1 where anything passed through a sheet, plate, wire or nail.
    int crossings = 0;
    int intersections = 0;   ///< number of cloth faces that touch the obstacle at the end, exact
    std::vector<int> faces;  ///< cloth faces with a part counted in either number, ascending

    bool is_clean() const { return faces.empty(); }
};

/// Checks the cloth's motion from `motion.begin` (free) to `motion.end` against every face, edge, wire and
/// point of the obstacle. With `motion.sides` both move linearly: from there to the obstacle and to
/// `motion.end`. No touch is missed. Elements that pass within 1e-11 of the size of a cloth face's swept box,
/// and began farther off, may count as touching. Positions must be finite.
///
/// Parallel; independent of the number of threads. Cloth far from the obstacle costs only its boxes; near it,
/// neighbouring cloth faces share one query.
SweepReport check_sweep(const Obstacle& obstacle, const ClothMotion& motion, double thickness);

}  // namespace arris
