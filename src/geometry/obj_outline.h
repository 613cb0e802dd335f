// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

/// What the lines of an OBJ file declare, before an importer that forgets it.
struct ObjOutline {
    int vertex_count = 0;
    int unused_vertex_count = 0;  ///< named by no face
    int face_count = 0;
    int line_and_point_count = 0;  ///< `l` and `p` elements
};

/// Reads the file's statements and checks every face's indices. Throws InputError naming the file and the
/// line for a face of fewer than three corners and for an index that is not a number, zero, or out of range
/// (negative ones count back from the last vertex, as the format has it).
ObjOutline read_obj_outline(const std::string& path);

}  // namespace arris
