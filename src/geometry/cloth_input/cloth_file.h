// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// A cloth mesh read from a file, and the warnings of the reader (one sentence each, with counts).
struct ClothFile {
    ClothMesh mesh;
    std::vector<std::string> warnings;
    bool has_uv = false;  ///< whether the file gives the material coordinates
    std::vector<int>
        vertices;  ///< of the mesh, for each `v` of the file in its order; -1 where no face uses it
    std::vector<std::array<int, 2>> ties;  ///< vertices that `stitch` statements hold together
};

/// Reads a cloth mesh. Polygons are cut in the material, or without UVs in their own plane. Positions become
/// the initial world positions, and UVs times `uv_scale` (m) the material coordinates. Flat pieces
/// without UVs are their own charts (flat_charts.h). `unit_in_metres` scales positions, not UVs. `up` is the
/// file's up axis, 'x', 'y' or 'z'; a rotation about a single axis turns it to +z. The only format is OBJ.
/// Edges that `stitch` statements end inside are divided (stitches.h).
/// Coordinates are the doubles nearest to the file's numbers (times `unit_in_metres`). Places with
/// several UVs are seams, along which charts are sewn together, or a chart to itself: a tube. Charts must not
/// overlap. Vertices are numbered in the order of their first use by faces. A
/// chart that is mirrored as a whole is mirrored back, with a warning.
///
/// Throws InputError naming the file if the mesh cannot be cloth:
///  - file unreadable, truncated or without faces; coordinates not finite or out of range;
///  - mesh not manifold, faces twice, without area or crossing themselves;
///  - overlapping or folded charts, charts that touch in a single place, a curved piece without UVs.
ClothFile read_cloth_file(const std::string& path, double unit_in_metres, char up, double uv_scale = 1.0);

}  // namespace arris
