// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

struct ThreeMfFile {
    ObstacleMesh soup;  ///< in the unit of the root part
    double metres_per_unit = 1e-3;
    std::vector<std::string> warnings;  ///< about objects that are left out
};

/// Reads the objects that the build of a 3MF package places, with their transforms, in double precision. The
/// root part is the one that the package's relationships name. Other parts, to which items and components may
/// refer, have units of their own. Objects that are no shape to keep (supports, and those of type "other")
/// are left out, with a warning.
///
/// Throws InputError, without the file's name, for an incomplete ZIP archive, a package without root part, a
/// part as read_three_mf_part describes, an object that is missing, a placed object whose shape an unknown
/// extension defines, components in a circle, and more than `most_faces` faces.
ThreeMfFile read_three_mf(std::string_view bytes, std::size_t most_faces);

}  // namespace arris
