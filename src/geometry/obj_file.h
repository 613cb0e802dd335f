// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
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

/// A corner of a face. Indices count from 0 into the file's vectors; `uv` is -1 where there is none, and may
/// be out of range, as obstacles do not use it.
struct ObjCorner {
    int vertex;
    int uv;
    int line;  ///< line of its face in the file
};

/// A `stitch a b c r` statement, as C-IPC (Li, Kaufman and Jiang 2021) has them: vertex a is to be held at
/// (1 - r) b + r c. Indices count from 0, here and in the file.
struct ObjStitch {
    std::array<int, 3> vertices;
    double share;
    int line;
};

/// Statements of an OBJ file in double precision and with their line numbers; the import library drops both.
struct ObjFile {
    std::vector<ObjVertex> vertices;
    std::vector<ObjUv> uvs;
    std::vector<ObjCorner> corners;  ///< corners of all faces, in the file's order
    std::vector<int> corner_counts;  ///< number of corners of each face, at least 3
    std::vector<std::array<int, 2>> segments;
    std::vector<int> lone_points;
    std::vector<ObjStitch> stitches;
    int line_and_point_count = 0;  ///< `l` and `p` statements
    int other_count = 0;           ///< statements of other kinds
    /// One sentence for each kind of statement that would change the shape, and is not read: free-form curves
    /// and surfaces, inclusion of other files, words that OBJ does not have.
    std::vector<std::string> warnings;
};

/// Reads the statements of an OBJ file (Wavefront's format, as its exporters write it): keywords in either
/// case, lines continued by a backslash, comments, any line ends, byte-order marks in front of lines. A
/// vertex has 3 numbers, then a weight (a single number), or a colour (any other number of them). Numbers are
/// correctly rounded: one written with 17 digits is read back unchanged.
///
/// Throws InputError, without the file's name, that begins with the line and says what is allowed:
///  - a `v` or `vt` with too few numbers, or words that are none; a weight of zero; a statement that begins
///    with `v` and is none of OBJ, as the vertices would then be miscounted;
///  - an element of too few corners;
///  - an index that is no number, zero or out of range (a negative one counts back from the last vertex).
/// Also for text in UTF-16, and bytes that are no text. Coordinates may be infinite or NaN, as a vertex that
/// no face names does no harm. Linear in the file's size.
ObjFile read_obj(std::string_view bytes);

}  // namespace arris
