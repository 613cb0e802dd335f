// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/obj_file.h"

namespace arris {

/// Reads an OBJ file (see read_obj) for a cloth. Throws InputError naming the file, the line, the statement
/// and what is allowed; also for faces with and without UVs in one file, UVs out of range, and a file without
/// faces.
ObjFile read_cloth_obj(const std::string& path);

}  // namespace arris
