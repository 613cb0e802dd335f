// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// A `v` statement: its numbers as the file states them, to the last bit.
struct ObjVertex {
    Vec3 place;
    int line;  ///< of the file, counted from 1
};

/// A `vt` statement, likewise.
struct ObjUv {
    Vec2 place;
    int line;
};

/// A corner of a face. Indices count from 0 into the outline's vectors; `uv` is -1 where there is none.
struct ObjCorner {
    int vertex;
    int uv;
    int line;  ///< of its face
};

/// What the lines of an OBJ file declare, in double precision and with their places in the file: importers
/// forget both.
struct ObjOutline {
    std::vector<ObjVertex> vertices;
    std::vector<ObjUv> uvs;
    std::vector<ObjCorner> corners;  ///< of all faces, in the file's order
    std::vector<int> corner_counts;  ///< of each face, at least 3
    int unused_vertex_count = 0;     ///< named by no face
    int line_and_point_count = 0;    ///< `l` and `p` elements
};

/// Reads the file's statements. Throws InputError naming the file, the line, the statement and what is
/// allowed for: a `v` or `vt` without its numbers, a face of fewer than three corners, an index that is not a
/// number, zero, or out of range (negative ones count back from the last vertex, as the format has it), faces
/// with and without UVs, and a file without faces. Numbers may be infinite or NaN: what no face names does no
/// harm. The numbers are correctly rounded, so that what was written with 17 digits comes back the same.
ObjOutline read_obj_outline(const std::string& path);

}  // namespace arris
