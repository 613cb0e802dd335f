// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "geometry/loop_triangulation.h"
#include "geometry/polygon_touch.h"
#include "geometry/tolerances.h"

// The sides of the polygon are constraints of a triangulation of its corners. A triangle belongs to the
// polygon if the polygon winds around it once, in either direction. Where a polygon touches itself without
// crossing, sides of opposite directions cancel.
namespace arris {
namespace {

using Triangulation = LoopTriangulation;
using VertexHandle = Triangulation::Vertex_handle;
using FaceHandle = Triangulation::Face_handle;

double cross(const Vec2& a, const Vec2& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

double twice_area(const std::vector<Vec2>& corners)
{
    double sum = 0.0;
    for (std::size_t k = 2; k < corners.size(); ++k)
        sum += cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
    return sum;
}

// Corners in an order that depends on their places only: counter-clockwise, from the lowest in a direction in
// which the corners of an upright rectangle, however rounded, have different heights.
std::vector<int> canonical_order(const std::vector<Vec2>& corners)
{
    const Vec2 direction(1.0, 0.618);
    std::vector<int> order(corners.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
    if (twice_area(corners) < 0.0) std::reverse(order.begin(), order.end());
    const auto lowest = std::min_element(order.begin(), order.end(), [&](int a, int b) {
        return direction.dot(corners[a]) < direction.dot(corners[b]);
    });
    std::rotate(order.begin(), lowest, order.end());
    return order;
}

// The Delaunay cut of a strictly convex quadrilateral a, b, c, d. Where both cuts are equally good, the cut
// at its first corner.
std::optional<std::vector<Face>> cut_convex_quad(const std::vector<Vec2>& corners,
                                                 const std::vector<int>& order)
{
    if (order.size() != 4) return std::nullopt;
    for (int k = 0; k < 4; ++k)
        if (exact_orientation(corners[order[k]], corners[order[(k + 1) % 4]], corners[order[(k + 2) % 4]]) !=
            1)
            return std::nullopt;
    const auto& [a, b, c, d] = std::array<int, 4>{order[0], order[1], order[2], order[3]};
    // sin(beta + delta), of the angles opposite to the cut from a to c
    const Vec2 ba = (corners[a] - corners[b]).normalized(), bc = (corners[c] - corners[b]).normalized();
    const Vec2 dc = (corners[c] - corners[d]).normalized(), da = (corners[a] - corners[d]).normalized();
    const double sine = cross(bc, ba) * dc.dot(da) + ba.dot(bc) * cross(da, dc);
    // Files round the corners of a rectangle.
    if (sine < -kThreeDigits) return std::vector<Face>{{a, b, d}, {b, c, d}};
    return std::vector<Face>{{a, b, c}, {a, c, d}};
}

class PolygonCutter {
  public:
    // `order` names corners as they follow each other; it may come to a corner more than once.
    PolygonCutter(const std::vector<Vec2>& corners, const std::vector<int>& order)
        : corners_(corners), order_(order)
    {
    }

    PolygonTriangles cut()
    {
        insert_corners();
        if (triangulation_.dimension() < 2) return {{}, PolygonDefect::NoArea, {}};
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        const std::size_t count = vertices_.size();
        try {
            for (std::size_t k = 0; k < count; ++k)
                if (vertices_[k] != vertices_[(k + 1) % count])
                    triangulation_.insert_constraint(vertices_[k], vertices_[(k + 1) % count]);
        } catch (const Triangulation::Intersection_of_constraints_exception&) {
            return {{}, PolygonDefect::CrossesItself, {}};
        }
        for (std::size_t k = 0; k < count; ++k) count_side(vertices_[k], vertices_[(k + 1) % count]);
        wind();
        return collect();
    }

  private:
    // Equal corners share a vertex.
    void insert_corners()
    {
        FaceHandle hint;
        for (const int k : order_) {
            const std::size_t known = triangulation_.number_of_vertices();
            const VertexHandle vertex = triangulation_.insert(to_cgal(corners_[k]), hint);
            if (triangulation_.number_of_vertices() > known) vertex->info() = k;
            vertices_.push_back(vertex);
            hint = vertex->face();
        }
    }

    // Counts the edges along the side from `from` to `to`; corners on the side divide it.
    void count_side(VertexHandle from, VertexHandle to)
    {
        while (from != to) {  // ends, as each edge leads nearer to `to`
            VertexHandle next;
            FaceHandle face;
            int index = 0;
            const bool is_found = triangulation_.includes_edge(from, to, next, face, index);
            CGAL_assertion(is_found);
            if (!is_found) return;
            ++runs_[{from->info(), next->info()}];
            --runs_[{next->info(), from->info()}];
            from = next;
        }
    }

    // Winding numbers spread from outside: crossing an edge changes the number by the runs along the edge.
    void wind()
    {
        std::vector<FaceHandle> reached = {triangulation_.infinite_face()};
        reached.front()->info() = 0;
        for (std::size_t next = 0; next < reached.size(); ++next) {
            const FaceHandle face = reached[next];
            for (int k = 0; k < 3; ++k) {
                const FaceHandle neighbour = face->neighbor(k);
                if (neighbour->info()) continue;
                neighbour->info() = *face->info() - runs_along(face, k);
                reached.push_back(neighbour);
            }
        }
    }

    // Runs along edge `k` of a face that have the face on their left.
    int runs_along(const FaceHandle& face, int k) const
    {
        const VertexHandle from = face->vertex(Triangulation::ccw(k));
        const VertexHandle to = face->vertex(Triangulation::cw(k));
        if (triangulation_.is_infinite(from) || triangulation_.is_infinite(to)) return 0;
        const auto found = runs_.find({from->info(), to->info()});
        return found == runs_.end() ? 0 : found->second;
    }

    PolygonTriangles collect() const
    {
        PolygonTriangles triangles;
        for (const FaceHandle face : triangulation_.finite_face_handles()) {
            const int number = *face->info();
            if (std::abs(number) > 1) return {{}, PolygonDefect::CrossesItself, {}};
            if (number == 0) continue;
            const int a = face->vertex(0)->info(), b = face->vertex(1)->info(), c = face->vertex(2)->info();
            triangles.faces.push_back(number > 0 ? Face{a, b, c} : Face{a, c, b});
        }
        if (triangles.faces.empty()) triangles.defect = PolygonDefect::NoArea;
        return triangles;
    }

    const std::vector<Vec2>& corners_;
    const std::vector<int>& order_;
    Triangulation triangulation_;
    std::vector<VertexHandle> vertices_;      // of the sides, in canonical order
    std::map<std::array<int, 2>, int> runs_;  // along an edge, less those in the opposite direction
};

// The normal by Newell's sum, not normalized; of the largest corner where the sum is rounding.
Vec3 normal_of(const std::vector<Vec3>& corners)
{
    Vec3 sum = Vec3::Zero();
    Vec3 largest = Vec3::Zero();
    const std::size_t count = corners.size();
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 &a = corners[k], &b = corners[(k + 1) % count], &c = corners[(k + 2) % count];
        sum += (a - corners[0]).cross(b - corners[0]);
        const Vec3 at_corner = (b - a).cross(c - b);
        if (at_corner.norm() > largest.norm()) largest = at_corner;
    }
    // The two halves of a symmetric bow-tie cancel, but for rounding.
    return sum.norm() > kSinglePrecision * largest.norm() ? sum : largest;
}

// Twice the area that the triangles cover.
double twice_area(const std::vector<Vec2>& corners, const std::vector<Face>& faces)
{
    double sum = 0.0;
    for (const auto& [a, b, c] : faces)
        sum += std::abs(cross(corners[b] - corners[a], corners[c] - corners[a]));
    return sum;
}

// Cuts a polygon that is no convex quadrilateral. Bends sides where the polygon touches itself but for
// rounding; keeps the exact cut if that would change its area by more than rounding does.
PolygonTriangles cut_polygon(const std::vector<Vec2>& corners, const std::vector<int>& order, NearTouch touch)
{
    PolygonTriangles exact = PolygonCutter(corners, order).cut();
    if (exact.defect == PolygonDefect::NoArea) return exact;
    if (exact.defect == PolygonDefect::None && touch == NearTouch::Keep) return exact;
    const double rounding = rounding_of(corners);
    PolygonLoop loop = join_touches(corners, order, rounding);
    if (loop.corners == order) return exact;
    PolygonTriangles bent = PolygonCutter(corners, loop.corners).cut();
    if (bent.defect != PolygonDefect::None) return exact;
    if (exact.defect == PolygonDefect::None) {
        double outline = 0.0;
        for (std::size_t k = 0; k < corners.size(); ++k)
            outline += (corners[(k + 1) % corners.size()] - corners[k]).norm();
        const double change = std::abs(twice_area(corners, bent.faces) - twice_area(corners, exact.faces));
        if (change > 2.0 * rounding * outline) return exact;
    }
    bent.joined = std::move(loop.joined);
    return bent;
}

// Whether `a` comes before `b` in an order of places.
bool precedes(const Vec3& a, const Vec3& b)
{
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// The first of two starts, by the places of the corners that follow; equal runs give equal fans. Only corners
// at one place need more than one comparison.
bool starts_first(const std::vector<Vec3>& corners, std::size_t a, std::size_t b)
{
    constexpr std::size_t kMostCompared = 100;
    const std::size_t count = corners.size();
    for (std::size_t k = 0; k < std::min(count, kMostCompared); ++k) {
        const Vec3 &p = corners[(a + k) % count], &q = corners[(b + k) % count];
        if (p != q) return precedes(p, q);
    }
    return false;
}

}  // namespace

PolygonTriangles triangulate_polygon(const std::vector<Vec2>& corners, NearTouch touch)
{
    const std::vector<int> order = canonical_order(corners);
    PolygonTriangles triangles;
    if (auto quad = cut_convex_quad(corners, order))
        triangles.faces = *std::move(quad);
    else
        triangles = cut_polygon(corners, order, touch);
    const bool is_reversed = twice_area(corners) < 0.0;
    for (Face& face : triangles.faces) {
        if (is_reversed) std::swap(face[1], face[2]);
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    }
    std::sort(triangles.faces.begin(), triangles.faces.end());
    return triangles;
}

PolygonTriangles triangulate_polygon(const std::vector<Vec3>& corners, NearTouch touch)
{
    const Vec3 normal = normal_of(corners);
    if (!(normal.norm() > 0.0)) return {{}, PolygonDefect::NoArea, {}};
    // Leaving out a coordinate rounds nothing: corners on a line, and equal corners, remain so. Of
    // coordinates that are about equal in the normal, the last, so that rounding does not choose.
    const Vec3 sizes = normal.cwiseAbs();
    int axis = 2;
    // A plane may lie at 45 degrees, but for rounding.
    while (axis > 0 && sizes[axis] < (1.0 - kThreeDigits) * sizes.maxCoeff()) --axis;
    std::vector<Vec2> flat;
    for (const Vec3& p : corners) flat.emplace_back(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    PolygonTriangles triangles = triangulate_polygon(flat, touch);
    if (triangles.defect == PolygonDefect::None) return triangles;
    // A polygon that is not flat may cross itself as seen along an axis, but not along its own normal.
    const Vec3 along_u = normal.unitOrthogonal();
    const Vec3 along_v = normal.normalized().cross(along_u);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 p = corners[k] - corners[0];
        flat[k] = {along_u.dot(p), along_v.dot(p)};
    }
    PolygonTriangles seen = triangulate_polygon(flat, touch);
    return seen.defect == PolygonDefect::None ? seen : triangles;
}

std::vector<Face> fan_polygon(const std::vector<Vec3>& corners)
{
    const int count = static_cast<int>(corners.size());
    int start = 0;
    for (int k = 1; k < count; ++k)
        if (starts_first(corners, k, start)) start = k;
    std::vector<Face> faces;
    for (int k = 2; k < count; ++k) faces.push_back({start, (start + k - 1) % count, (start + k) % count});
    return faces;
}

PolygonBend find_bend(const std::vector<Vec3>& corners)
{
    PolygonBend bend;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : corners) middle += (p - corners[0]) / static_cast<double>(corners.size());
    const Vec3 normal = normal_of(corners).stableNormalized();
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 from_middle = corners[k] - corners[0] - middle;
        bend.size = std::max(bend.size, from_middle.norm());
        const double distance = std::abs(from_middle.dot(normal));
        if (distance <= bend.distance) continue;
        bend.distance = distance;
        bend.corner = static_cast<int>(k);
    }
    return bend;
}

}  // namespace arris
