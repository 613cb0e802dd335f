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

/// A `vt` statement: its numbers as the file states them, to the last bit.
struct ObjUv {
    Vec2 place;
    int line;
};

/// A corner of a face. Indices count from 0 into the outline's vectors; `uv` is -1 where there is none.
struct ObjCorner {
    int vertex;
    int uv;
    int line;  ///< line of its face in the file
};

/// Statements of an OBJ file in double precision and with their line numbers; importers drop both.
struct ObjOutline {
    std::vector<ObjVertex> vertices;
    std::vector<ObjUv> uvs;
    std::vector<ObjCorner> corners;  ///< corners of all faces, in the file's order
    std::vector<int> corner_counts;  ///< number of corners of each face, at least 3
    int unused_vertex_count = 0;     ///< vertices that no face names
    int line_and_point_count = 0;    ///< `l` and `p` elements
};

/// Reads the file's statements, in every spelling that canonical_obj allows. Throws InputError naming the
/// file, the line, the statement and what is allowed:
///  - a `v` or `vt` without its numbers; a face of fewer than three corners;
///  - an index that is not a number, zero or out of range (a negative one counts back from the last vertex);
///  - faces with and without UVs in one file; a file without faces; text in UTF-16.
/// Numbers may be infinite or NaN, as a vertex that no face names does no harm. Numbers are correctly
/// rounded: one written with 17 digits is read back unchanged.
ObjOutline read_obj_outline(const std::string& path);

}  // namespace arris
