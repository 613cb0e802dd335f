// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "geometry/obstacle_input/formats/plain_mesh.h"

namespace arris {

/// Reads an STL file, binary or text. Each face has three points of its own. Words of a text may be in either
/// case, and lines and blanks where they like; comments begin with # or //; names and normals are not used.
///
/// Throws InputError, without the file's name, for a binary file whose length is not that of its count of
/// faces, and for a text with a face that is not three vertices of three numbers, or without its end. A
/// warning says how many bytes, fewer than a face has, follow the last face of a binary file.
PlainMesh read_stl(std::string_view bytes);

}  // namespace arris
