// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/face_cutter.h"

#include <fmt/format.h>

#include <utility>

#include "geometry/mesh_text.h"
#include "geometry/polygon.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

std::string place(const Vec3& p)
{
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}] (m, z up, before it is scaled and placed)", p.x(), p.y(),
                       p.z());
}

}  // namespace

std::vector<Face> FaceCutter::cut(const std::vector<Vec3>& corners, int first_point, double scale)
{
    if (corners.size() == 3) return {{0, 1, 2}};
    PolygonTriangles triangles = triangulate_polygon(corners);
    if (triangles.defect == PolygonDefect::CrossesItself && crossing_++ == 0) crossing_point_ = first_point;
    if (triangles.defect != PolygonDefect::None) return fan_polygon(corners);
    const PolygonBend bend = find_bend(corners);
    // A polygon with a corner farther from its plane: the choice of triangles changes the shape visibly.
    if (bend.distance > kThreeDigits * bend.size) {
        ++bent_;
        if (bend.distance > bent_share_ * bend.size) {
            bent_share_ = bend.distance / bend.size;
            bent_distance_ = scale * bend.distance;
            bent_point_ = first_point;
        }
    }
    return std::move(triangles.faces);
}

std::vector<std::string> FaceCutter::warnings(const std::vector<Vec3>& points, double unit) const
{
    std::vector<std::string> told;
    if (crossing_ > 0)
        told.push_back(
            fmt::format("{}; {} has a corner at {}: order the corners around {} where the file was made",
                        counted(crossing_, "polygon crosses itself, so that its triangles overlap",
                                "polygons cross themselves, so that their triangles overlap"),
                        crossing_ == 1 ? "it" : "the first", place(points[crossing_point_]),
                        crossing_ == 1 ? "it" : "them"));
    if (bent_ > 0)
        told.push_back(
            fmt::format("{}; {} has a corner at {} and is {:.2g} m off its plane ({:.2g} of its size): its "
                        "shape depends on "
                        "how it is cut into triangles; cut it where the file was made",
                        counted(bent_, "polygon is not flat", "polygons are not flat"),
                        bent_ == 1 ? "it" : "the most bent", place(points[bent_point_]),
                        bent_distance_ * unit, bent_share_));
    return told;
}

}  // namespace arris
