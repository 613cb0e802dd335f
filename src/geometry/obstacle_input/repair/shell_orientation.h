// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// Findings of `orient_shells`.
struct ShellReport {
    int border_edges = 0;    ///< of sheets
    int crossing_pairs = 0;  ///< pairs of faces that cross, overlap, or touch without sharing a vertex there
    Vec3 crossing_place = Vec3::Zero();  ///< near the first of these pairs, in the order of the mesh's faces
    int cavities = 0;                    ///< shells that bound a cavity
    int turned_shells = 0;               ///< closed components whose faces were all reversed
};

/// Orients each closed component (shell) counter-clockwise seen from outside the solid. Its normals point
/// outward, unless it lies inside an odd number of other shells: then it bounds a cavity. Shells that cross
/// or touch are treated as separate solids, neither inside the other. Sheets are unchanged.
///
/// The mesh must be manifold and consistently oriented, as `validate` requires. Exact predicates decide
/// crossings and nesting. O(n log n) plus the number of crossings; each pair of nested shells costs a query.
ShellReport orient_shells(ObstacleMesh& mesh);

}  // namespace arris
