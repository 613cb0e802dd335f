// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/mesh_target.h"
#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// Least angle of a face in material space, degrees; negative if it is clockwise.
double least_angle(const PatchFace& face);
/// Least angle of all faces in material space, degrees; 180 if there are none.
double least_angle(const std::vector<PatchFace>& faces);
/// Length of the longest edge in material space, m; 0 if there are no faces.
double longest_edge(const std::vector<PatchFace>& faces);
Vec2 material_centre(const PatchFace& face);

}  // namespace arris
