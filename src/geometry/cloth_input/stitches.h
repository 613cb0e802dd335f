// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/obj_file.h"

namespace arris {

/// A vertex that is to be held at a point of an edge: (1 - share) begin + share end.
struct Stitch {
    int vertex = 0;
    int begin = 0, end = 0;
    double share = 0.0;
    int line = 0;  ///< of the file
};

/// Stitches by vertices of a mesh. `vertices`: as ClothFile's. Throws InputError, which names the line, where
/// a vertex is not there.
std::vector<Stitch> number_stitches(const std::vector<ObjStitch>& stitches, const std::vector<int>& vertices);

/// Pairs of different vertices to be held together, by stitch. The edges of `mesh` that stitches end inside
/// are divided there; within a quarter of an edge from a vertex of it, the stitch ends on that vertex. On
/// sewn cloth no edge is divided. Throws InputError, which names the line, where begin and end are no edge.
std::vector<std::array<int, 2>> divide_at_stitches(const std::vector<Stitch>& stitches, ClothMesh& mesh);

}  // namespace arris
