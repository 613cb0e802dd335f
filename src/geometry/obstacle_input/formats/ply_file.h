// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "geometry/obstacle_input/formats/plain_mesh.h"

namespace arris {

/// Reads a PLY file (Turk's format: text, or binary of either byte order): vertices, faces and triangle
/// strips
/// (`tristrips`; a negative index begins a new strip). A face of two corners is a line, of one corner a
/// point. A file without faces is a cloud of points.
///
/// Throws InputError, without the file's name: for an invalid header; vertices without x, y and z; faces or
/// strips without a list `vertex_indices` or `vertex_index`, and lists under other names in a file without
/// faces; an index out of range; a number that is none; a text whose lines do not hold one element each; and
/// a list or element longer than the rest of the file. Returns a warning for each element that is not read.
/// Linear in the number of bytes; no allocation depends on the header's counts.
PlainMesh read_ply(std::string_view bytes);

}  // namespace arris
