// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// An obstacle that passes `validate`.
struct RepairedSoup {
    ObstacleMesh mesh;
    std::vector<int> welded;   ///< name of each of the soup's points, equal for joined ones; -1 if unused
    std::vector<int> origins;  ///< name that each of the mesh's points comes from; -1 for a new point
    double tolerance = 0.0;    ///< m: joined points were no farther apart
    std::vector<std::string> warnings;  ///< one sentence for each kind of repair, with its count
    std::vector<std::string> notes;     ///< findings that are legitimate but worth knowing ("open: 4 border
                                        ///< edges, ...")
};

/// Makes an obstacle from faces in any order and orientation, segments and lone points (m). Welds points and
/// drops duplicates and faces without area. Cuts the surface apart where more than two faces meet at an edge,
/// or faces meet at a vertex only. Orients neighbours consistently, closed shells outward and cavities
/// inward. Open surfaces remain sheets. Crossing faces remain; a warning counts them. Points, faces and
/// segments keep their order.
///
/// Throws InputError for coordinates that are not finite or beyond 1e6 m, indices out of range, and an empty
/// result. The error names a point or face by its number, counted from 1. About 0.5 s for 1e5 faces.
RepairedSoup repair_soup(ObstacleMesh soup);

}  // namespace arris
