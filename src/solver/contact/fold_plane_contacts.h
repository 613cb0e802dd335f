// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/eol/eol_coordinates.h"
#include "solver/eol/wire_fold.h"

namespace arris {

/// A vertex of the cloth that is kept on its side of the fold plane behind an EOL vertex on a wire
/// (wire_fold.h).
struct FoldPlaneContact {
    int vertex;
    int obstacle;  ///< index in the scene
    FoldPlaneBound bound;
    Vec3 point;  ///< on the wire
};

/// Contacts for the neighbours of EOL vertices on wires, and for cloth beyond them that will soon slide
/// there. Each vertex is kept off its nearest plane. Vertices past the wire's end are included only as direct
/// neighbours. `positions`: the cloth in the frame of each obstacle at the step's start. Sorted by (vertex,
/// obstacle, polyline), without duplicates.
std::vector<FoldPlaneContact> find_fold_plane_contacts(
    const std::vector<MovingObstacle>& obstacles, const State& state, const ClothStars& stars,
    const std::vector<EolCoordinates>& eol, const std::vector<const std::vector<Vec3>*>& positions);

}  // namespace arris
