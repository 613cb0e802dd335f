// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/seam_triangles.h"

#include <algorithm>

#include "geometry/cgal.h"

namespace arris {

std::vector<Face> cut_off_seams(const SeamCorners& corners, const std::vector<Face>& triangles)
{
    const auto count = [&](const std::vector<Face>& faces) {
        return std::count_if(faces.begin(), faces.end(), [&](const Face& face) {
            return std::all_of(face.begin(), face.end(), [&](int k) { return corners[k].is_on_seam; });
        });
    };
    if (triangles.size() != 2 || count(triangles) == 0) return triangles;
    const auto turn = [&](const Face& face) {
        return exact_orientation(corners[face[0]].uv, corners[face[1]].uv, corners[face[2]].uv);
    };
    for (const std::vector<Face>& other :
         {std::vector<Face>{{0, 1, 2}, {0, 2, 3}}, std::vector<Face>{{0, 1, 3}, {1, 2, 3}}})
        if (count(other) < count(triangles) && turn(other[0]) == turn(triangles[0]) &&
            turn(other[1]) == turn(triangles[0]))
            return other;
    return triangles;
}

}  // namespace arris
