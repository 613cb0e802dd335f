// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// What `orient_shells` found.
struct ShellReport {
    int border_edges = 0;    ///< of sheets
    int crossing_pairs = 0;  ///< pairs of faces that cross, overlap, or touch without sharing a vertex there
    Vec3 crossing_place = Vec3::Zero();  ///< near where the first of these pairs does, of the mesh's faces
    int cavities = 0;                    ///< shells seen from within
    int turned_shells = 0;               ///< closed components whose faces were all turned round
};

/// Turns the faces of each closed component (shell) so that they are counter-clockwise seen from outside the
/// solid: outward, unless the shell lies inside an odd number of other shells, where it bounds a cavity.
/// Shells that cross or touch are taken for solids side by side, neither inside the other. Sheets stay as
/// they are. The mesh must be manifold and oriented, as `validate` asks. Crossings and nesting are decided by
/// exact predicates. O(n log n) and the number of crossings; nested shells cost a query a pair.
ShellReport orient_shells(ObstacleMesh& mesh);

}  // namespace arris
