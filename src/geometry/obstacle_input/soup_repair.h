// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// An obstacle that passes `validate`.
struct RepairedSoup {
    ObstacleMesh mesh;
    std::vector<std::string> warnings;  ///< one sentence for each kind of repair, with its count
    std::vector<std::string> notes;     ///< what is legitimate but good to know ("open: 4 border edges, ...")
};

/// Makes an obstacle of faces in any order and orientation, segments and lone points (m). Welds points;
/// drops duplicates and faces without area; cuts apart where more than two faces meet at an edge, or faces
/// meet at a vertex only; orients neighbours alike, closed shells outward and cavities inward. Open surfaces
/// stay sheets, crossing faces stay crossing (a warning counts them). Points, faces and segments keep their
/// order. Throws InputError, which names a point or face by its number counted from 1, for coordinates that
/// are not finite or beyond 1e6 m, indices out of range, and where nothing is left. About 0.5 s for 1e5
/// faces.
RepairedSoup repair_soup(ObstacleMesh soup);

}  // namespace arris
