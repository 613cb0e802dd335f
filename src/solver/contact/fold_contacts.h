// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/eol/eol_coordinates.h"
#include "solver/eol/wire_fold.h"

namespace arris {

/// A vertex of the cloth that is kept on its side of the plane behind a vertex on a wire (wire_fold.h).
struct FoldContact {
    int vertex;
    int obstacle;  ///< index in the scene
    FoldBound bound;
    Vec3 point;  ///< of the wire
};

/// Of the neighbours of the vertices on wires, and of theirs, which sliding will make such: each against the
/// plane that it is nearest to; what is past the wire's end only where it is a neighbour. `positions`: the
/// cloth's in the frame of each obstacle at the step's start. Sorted by (vertex, obstacle, polyline), each
/// once.
std::vector<FoldContact> find_fold_contacts(const std::vector<Obstacle>& obstacles, const State& state,
                                            const ClothStars& stars, const std::vector<EolCoordinates>& eol,
                                            const std::vector<const std::vector<Vec3>*>& positions);

}  // namespace arris
