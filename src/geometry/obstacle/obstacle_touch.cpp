// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_touch.h"

#include <CGAL/Triangle_3.h>
#include <CGAL/intersections.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "geometry/cgal.h"
#include "geometry/closest_point.h"

namespace arris {
namespace {

using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;

/// Whether a point lies on a closed triangle of non-zero area.
bool is_on(const Point3& p, const Point3& a, const Point3& b, const Point3& c)
{
    if (CGAL::orientation(a, b, c, p) != CGAL::COPLANAR) return false;
    return CGAL::coplanar_orientation(a, b, c, p) != CGAL::NEGATIVE &&
           CGAL::coplanar_orientation(b, c, a, p) != CGAL::NEGATIVE &&
           CGAL::coplanar_orientation(c, a, b, p) != CGAL::NEGATIVE;
}

bool is_on(const Point3& p, const Point3& a, const Point3& b)
{
    return CGAL::collinear(a, p, b) && CGAL::collinear_are_ordered_along_line(a, p, b);
}

/// The set of points that a cloth triangle covers: a triangle (dimension 2), a segment (1) or a point (0).
struct Shape {
    std::array<Point3, 3> corners;
    int dimension;

    explicit Shape(const std::array<Vec3, 3>& triangle)
        : corners{to_cgal(triangle[0]), to_cgal(triangle[1]), to_cgal(triangle[2])}, dimension(2)
    {
        if (!CGAL::collinear(corners[0], corners[1], corners[2])) return;
        // Lexicographic order is the order along the line.
        std::sort(corners.begin(), corners.end());
        corners[1] = corners[2];
        dimension = corners[0] == corners[1] ? 0 : 1;
    }

    bool touches(const Point3& p) const
    {
        if (dimension == 2) return is_on(p, corners[0], corners[1], corners[2]);
        return dimension == 1 ? is_on(p, corners[0], corners[1]) : p == corners[0];
    }

    /// The segment must have a length.
    bool touches(const Point3& a, const Point3& b) const
    {
        if (dimension == 2)
            return CGAL::do_intersect(Triangle(corners[0], corners[1], corners[2]), Segment(a, b));
        if (dimension == 1) return CGAL::do_intersect(Segment(corners[0], corners[1]), Segment(a, b));
        return is_on(corners[0], a, b);
    }
};

void find_faces(const Obstacle& obstacle, const Shape& shape, const Box3& box, std::vector<int>& found)
{
    const Vec3 a = to_eigen(shape.corners[0]), b = to_eigen(shape.corners[1]), c = to_eigen(shape.corners[2]);
    if (shape.dimension == 2) {
        obstacle.find_faces_touching(a, b, c, found);
    } else if (shape.dimension == 1) {
        obstacle.find_faces_touching(a, b, found);
    } else {
        obstacle.find_faces(box, found);
        const std::vector<Vec3>& points = obstacle.mesh().points;
        std::erase_if(found, [&](int f) {
            const Face& face = obstacle.mesh().faces[f];
            return !is_on(shape.corners[0], to_cgal(points[face[0]]), to_cgal(points[face[1]]),
                          to_cgal(points[face[2]]));
        });
    }
}

}  // namespace

void find_touches(const Obstacle& obstacle, const std::array<Vec3, 3>& triangle, ObstacleTouch& found)
{
    found.faces.clear();
    found.segments.clear();
    found.lone_points.clear();
    Box3 box;
    for (const Vec3& p : triangle) box.extend(p);
    if (!box.intersects(obstacle.bounds())) return;
    const Shape shape(triangle);
    find_faces(obstacle, shape, box, found.faces);

    const ObstacleTopology& topology = obstacle.topology();
    const std::vector<Vec3>& points = obstacle.mesh().points;
    if (!obstacle.mesh().segments.empty()) {
        obstacle.find_feature_edges(box, found.segments);
        for (int& e : found.segments) e = obstacle.features().edges[e].edge;
        std::erase_if(found.segments, [&](int e) {
            const std::array<int, 2>& ends = topology.edges[e].points;
            return e < topology.surface_edge_count ||
                   !shape.touches(to_cgal(points[ends[0]]), to_cgal(points[ends[1]]));
        });
    }
    if (!obstacle.mesh().lone_points.empty()) {
        obstacle.find_corners(box, found.lone_points);
        for (int& p : found.lone_points) p = obstacle.features().corners[p].point;
        // A point with edges is reported through those edges.
        std::erase_if(found.lone_points, [&](int p) {
            return topology.edge_count_at(p) > 0 || !shape.touches(to_cgal(points[p]));
        });
    }
}

bool is_touching(const std::array<Vec3, 3>& triangle, const std::array<Vec3, 2>& segment)
{
    const Shape shape(triangle);
    const Point3 a = to_cgal(segment[0]), b = to_cgal(segment[1]);
    return a == b ? shape.touches(a) : shape.touches(a, b);
}

namespace {

Vec3 normal_of(const std::array<Vec3, 3>& t)
{
    return (t[1] - t[0]).stableNormalized().cross((t[2] - t[0]).stableNormalized()).stableNormalized();
}

/// Averages the candidate points that lie on a triangle. Where rounding put all of them off the triangle, the
/// nearest one stands in.
struct Meeting {
    double tolerance;
    Vec3 sum = Vec3::Zero();
    int count = 0;
    Vec3 nearest = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();

    void add(const Vec3& place, const std::array<Vec3, 3>& triangle, const Vec3& normal)
    {
        const double gap = (place - closest_on_triangle(place, triangle, normal).point).norm();
        if (gap < least) {
            least = gap;
            nearest = place;
        }
        if (gap > tolerance) return;
        sum += place;
        ++count;
    }

    /// Adds the corners of `one`, and the points where its sides cross the plane of `other`.
    void add_sides(const std::array<Vec3, 3>& one, const std::array<Vec3, 3>& other)
    {
        const Vec3 normal = normal_of(other);
        for (int i = 0; i < 3; ++i) {
            const Vec3& a = one[i];
            const Vec3& b = one[(i + 1) % 3];
            add(a, other, normal);
            const double above = normal.dot(a - other[0]), below = normal.dot(b - other[0]);
            if ((above > 0.0) != (below > 0.0)) add(a + above / (above - below) * (b - a), other, normal);
        }
    }
};

}  // namespace

Vec3 middle_of_touch(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second)
{
    double size = 0.0;
    for (const std::array<Vec3, 3>* t : {&first, &second})
        for (const Vec3& p : *t) size = std::max({size, (p - first[0]).norm(), p.cwiseAbs().maxCoeff()});
    Meeting meeting{1e-13 * size};  // rounding error of an intersection; larger for needles, where the
                                    // nearest point stands in
    meeting.add_sides(first, second);
    meeting.add_sides(second, first);
    return meeting.count > 0 ? Vec3(meeting.sum / meeting.count) : meeting.nearest;
}

}  // namespace arris
