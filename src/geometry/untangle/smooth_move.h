// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/untangle/collision_mesh.h"

namespace arris {

struct MoveTerm {
    int vertex;
    Vec3 weight;
};

/// Asks of a move u, in m: sum of weight . u[vertex] >= change.
struct MoveRow {
    std::vector<MoveTerm> terms;
    double change = 0.0;
};

struct SmoothMove {
    std::vector<Vec3> move;  ///< u, m, of all vertices
    double work;             ///< m^2, the least value of the sum below: how much it deforms the cloth
};

/// The smooth move that fulfils `rows` up to some per cent. It minimises
///     sum over edges of |u_a - u_b|^2 + (1 / reach^2) sum |u|^2 + stiffness * squared shortfalls of the rows
/// so that it decays over `reach` (edges, >= 1) from the rows. Vertices that may not move have exactly 0, and
/// so have those farther than a few reaches.
SmoothMove find_smooth_move(const CollisionMesh& mesh, const std::vector<MoveRow>& rows, double reach);

}  // namespace arris
