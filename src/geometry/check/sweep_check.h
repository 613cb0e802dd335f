// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/contact/obstacle_contact.h"

namespace arris {

/// What a step's way did to an obstacle. Clean: the surface is free of it at the end, by exact predicates,
/// and nothing of the one met anything of the other on the way.
struct SweepReport {
    /// What would have prevented it: planes with the cloth's point on the free side at begin, that the end
    /// violates. `least_gap` is the thickness, or the gap at begin where that was less (never one at the
    /// end). Of the vertices and edges a cloth face owns (each belongs to one face) and of itself the deepest
    /// past the meeting point, at most 9; of a vertex what it met first. Sorted by (kind, vertices, element),
    /// each once. May be empty where the cloth was not free at begin.
    std::vector<ObstacleContact> violations;
    /// Vertices that met a face on their way, edges that met an edge or a wire, and faces that met a point,
    /// each counted once, whether they went through, stopped inside, came back or touched. 0 where the step
    /// is clean, at least 1 where anything passed through: sheet, plate, wire or nail.
    int crossings = 0;
    int intersections = 0;   ///< cloth faces that touch the obstacle at the end, exact
    std::vector<int> faces;  ///< cloth faces of which a part is counted in either, ascending

    bool is_clean() const { return faces.empty(); }
};

/// Checks the cloth's way from `motion.begin` (free) to `motion.end` against every face, edge, wire and point
/// of the obstacle. Nothing that touches is missed; what passes within 1e-11 of the size of a cloth face's
/// swept box, and began farther off, may count as touching. Positions must be finite. Parallel; the same at
/// any thread count. Cost follows what is near: cloth that is far costs its boxes, the rest one query for a
/// handful of cloth faces that lie together.
SweepReport check_sweep(const Obstacle& obstacle, const ClothMotion& motion, double thickness);

}  // namespace arris
