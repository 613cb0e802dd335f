// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/face_cutter.h"

#include <fmt/format.h>

#include <utility>

#include "geometry/polygon.h"

namespace arris {

std::vector<Face> FaceCutter::cut(const std::vector<Vec3>& corners, int first_point)
{
    if (corners.size() == 3) return {{0, 1, 2}};
    PolygonTriangles triangles = triangulate_polygon(corners);
    if (triangles.defect == PolygonDefect::CrossesItself && crossing_++ == 0) crossing_point_ = first_point;
    if (triangles.defect != PolygonDefect::None)
        for (int k = 2; k < static_cast<int>(corners.size()); ++k) triangles.faces.push_back({0, k - 1, k});
    return std::move(triangles.faces);
}

std::string FaceCutter::tell_crossing(const std::vector<Vec3>& points) const
{
    const Vec3& p = points[crossing_point_];
    return fmt::format(
        "{} polygons cross themselves, so that their triangles overlap, the first with a corner at [{:.6g}, "
        "{:.6g}, "
        "{:.6g}] (m, z up, before it is scaled and placed): order their corners around them where the file "
        "was made",
        crossing_, p.x(), p.y(), p.z());
}

}  // namespace arris
