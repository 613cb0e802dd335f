// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// A cloth mesh read from a file, and what was noticed on the way (one sentence each, with counts).
struct ClothFile {
    ClothMesh mesh;
    std::vector<std::string> warnings;
};

/// Reads a mesh (polygons are triangulated): positions become the initial world positions, UVs (in metres)
/// the material coordinates; a flat mesh without UVs is its own chart. `unit_in_metres` scales positions (not
/// UVs), `up` is 'x', 'y' or 'z': the file's up axis, turned to +z about a single axis. Formats today: OBJ;
/// coordinates are the doubles nearest to the file's numbers (times `unit_in_metres`). Several pieces are
/// allowed if their charts are apart. Vertices are numbered in the order in which faces first name them; a
/// chart that is mirrored as a whole is turned round with a warning. Throws InputError naming the file for
/// whatever cannot be cloth: unreadable, truncated, no faces, non-finite or out-of-range, non-manifold,
/// duplicate faces or faces without area, UV seams (a place with two UVs), overlapping or folded charts,
/// curved without UVs.
ClothFile read_cloth_file(const std::string& path, double unit_in_metres, char up);

}  // namespace arris
