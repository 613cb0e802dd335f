// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Triangle_3.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

#include "geometry/cgal.h"
#include "geometry/closest_point.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using FaceTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>>>;
using SegmentTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_segment_primitive<Kernel, std::vector<Segment>::const_iterator>>>;

/// Writes the indices of the primitives that a query intersects, ascending, of those in the tree.
template <typename Tree, typename Query, typename Items>
void find_in(const Tree& tree, const Query& query, const Items& items, std::vector<int>& found)
{
    found.clear();
    if (tree.empty()) return;
    std::vector<typename Tree::Primitive_id> ids;
    tree.all_intersected_primitives(query, std::back_inserter(ids));
    for (const auto& id : ids) found.push_back(static_cast<int>(id - items.begin()));
    std::sort(found.begin(), found.end());
}

/// Whether one of the three sides of a triangle without area meets something.
template <typename Query>
bool touches_side_of(const Triangle& flat, const Query& query)
{
    for (int i = 0; i < 3; ++i) {
        const Segment side(flat.vertex(i), flat.vertex(i + 1));
        if (side.is_degenerate() ? CGAL::do_intersect(query, side.source()) : CGAL::do_intersect(query, side))
            return true;
    }
    return false;
}

CGAL::Bbox_3 to_cgal(const Box3& box)
{
    return {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
}

Box3 box_of(const ObstacleMesh& mesh)
{
    Box3 box;
    for (const Vec3& p : mesh.points) box.extend(p);
    return box;
}

}  // namespace

struct Obstacle::Trees {
    std::vector<Triangle> triangles;
    std::vector<Segment> feature_edges;
    std::vector<Box3> edge_boxes;
    FaceTree faces;
    SegmentTree edges;
    std::vector<int> flat;  ///< faces without area, ascending; not in the tree, which wants proper triangles
    std::vector<Vec3> corners;
    std::vector<int>
        corners_by_x;  ///< corners that are awake, sorted by x; a list suffices, as corners are few

    Trees(const ObstacleMesh& mesh, const ObstacleTopology& topology, const ObstacleFeatures& features)
    {
        for (const auto& [a, b, c] : mesh.faces)
            triangles.emplace_back(arris::to_cgal(mesh.points[a]), arris::to_cgal(mesh.points[b]),
                                   arris::to_cgal(mesh.points[c]));
        for (const FeatureEdge& feature : features.edges) {
            const std::array<int, 2>& ends = topology.edges[feature.edge].points;
            feature_edges.emplace_back(arris::to_cgal(mesh.points[ends[0]]),
                                       arris::to_cgal(mesh.points[ends[1]]));
            edge_boxes.push_back(Box3(mesh.points[ends[0]]).extend(mesh.points[ends[1]]));
        }
        insert_faces();
        insert_edges(features);
        for (const FeatureCorner& corner : features.corners) {
            if (corner.is_awake) corners_by_x.push_back(static_cast<int>(corners.size()));
            corners.push_back(mesh.points[corner.point]);
        }
        std::sort(corners_by_x.begin(), corners_by_x.end(),
                  [&](int i, int j) { return std::pair(corners[i].x(), i) < std::pair(corners[j].x(), j); });
    }

    // The trees are built now: a tree that builds itself at its first query does so under a lock.
    void insert_faces()
    {
        for (auto triangle = triangles.cbegin(); triangle != triangles.cend(); ++triangle)
            if (triangle->is_degenerate())
                flat.push_back(static_cast<int>(triangle - triangles.cbegin()));
            else
                faces.insert(FaceTree::Primitive(triangle));
        if (!faces.empty()) faces.build();
    }

    void insert_edges(const ObstacleFeatures& features)
    {
        for (std::size_t f = 0; f < feature_edges.size(); ++f)
            if (features.edges[f].is_awake && !feature_edges[f].is_degenerate())
                edges.insert(SegmentTree::Primitive(feature_edges.cbegin() + static_cast<std::ptrdiff_t>(f)));
        if (!edges.empty()) edges.build();
        for (std::size_t f = 0; f < feature_edges.size(); ++f)
            if (!features.edges[f].is_awake) edge_boxes[f].setEmpty();
    }

    /// Appends the flat faces whose boxes `meets`, in place.
    template <typename Meets>
    void add_flat(const Meets& meets, std::vector<int>& found) const
    {
        if (flat.empty()) return;
        for (const int f : flat)
            if (meets(triangles[f])) found.push_back(f);
        std::sort(found.begin(), found.end());
    }
};

Obstacle::Obstacle(ObstacleMesh mesh, double feature_angle, const VisitPoses& visit_poses)
    : mesh_(std::move(mesh)),
      topology_(make_topology(mesh_)),
      feature_angle_(feature_angle),
      features_(visit_poses ? find_features_of_poses(mesh_, topology_, feature_angle, visit_poses)
                            : find_features(mesh_, topology_, feature_angle)),
      bounds_(box_of(mesh_)),
      trees_(std::make_unique<Trees>(mesh_, topology_, features_))
{
    assert(validate(mesh_).empty());
}

Obstacle::Obstacle(const Obstacle& shape, std::vector<Vec3> points)
    : mesh_{std::move(points), shape.mesh_.faces, shape.mesh_.segments, shape.mesh_.lone_points},
      topology_(shape.topology_),
      feature_angle_(shape.feature_angle_),
      features_(shape.features_),
      bounds_(box_of(mesh_))
{
    update_normals(mesh_, topology_);
    pose_features(mesh_, topology_, feature_angle_, features_);
    trees_ = std::make_unique<Trees>(mesh_, topology_, features_);
}

Obstacle::~Obstacle() = default;
Obstacle::Obstacle(Obstacle&&) noexcept = default;
Obstacle& Obstacle::operator=(Obstacle&&) noexcept = default;

void Obstacle::find_faces(const Box3& box, std::vector<int>& found) const
{
    found.clear();
    if (!box.intersects(bounds_)) return;
    find_in(trees_->faces, to_cgal(box), trees_->triangles, found);
    trees_->add_flat([&](const Triangle& flat) { return CGAL::do_overlap(flat.bbox(), to_cgal(box)); },
                     found);
}

void Obstacle::find_feature_edges(const Box3& box, std::vector<int>& found) const
{
    constexpr std::size_t kFew = 16;  // up to this count (a box has 12) a linear scan is faster than the tree
    found.clear();
    if (!box.intersects(bounds_)) return;
    if (trees_->feature_edges.size() > kFew)
        return find_in(trees_->edges, to_cgal(box), trees_->feature_edges, found);
    for (std::size_t f = 0; f < trees_->feature_edges.size(); ++f)
        if (trees_->edge_boxes[f].intersects(box) &&
            CGAL::do_intersect(to_cgal(box), trees_->feature_edges[f]))
            found.push_back(static_cast<int>(f));
}

void Obstacle::find_corners(const Box3& box, std::vector<int>& found) const
{
    found.clear();
    const std::vector<Vec3>& points = trees_->corners;
    const std::vector<int>& by_x = trees_->corners_by_x;
    const auto begin = std::lower_bound(by_x.begin(), by_x.end(), box.min().x(),
                                        [&](int corner, double x) { return points[corner].x() < x; });
    const auto end = std::upper_bound(begin, by_x.end(), box.max().x(),
                                      [&](double x, int corner) { return x < points[corner].x(); });
    for (auto at = begin; at < end; ++at)
        if (box.contains(points[*at])) found.push_back(*at);
    std::sort(found.begin(), found.end());
}

int Obstacle::find_nearest_face(const Vec3& place, double most) const
{
    int nearest = -1;
    double least = most;
    if (!trees_->faces.empty()) {
        // A hint that is no nearer than `most` comes back where no face is.
        const Kernel::Point_3 query = arris::to_cgal(place);
        const Kernel::Point_3 far(place.x() + most, place.y(), place.z());
        const auto found = trees_->faces.closest_point_and_primitive(query, {far, trees_->triangles.cend()});
        if (found.second != trees_->triangles.cend()) {
            nearest = static_cast<int>(found.second - trees_->triangles.cbegin());
            least = std::sqrt(CGAL::squared_distance(query, found.first));
        }
    }
    for (const int f : trees_->flat)
        for (int i = 0; i < 3; ++i) {
            const Face& corners = mesh_.faces[f];
            const Vec3 &a = mesh_.points[corners[i]], &b = mesh_.points[corners[(i + 1) % 3]];
            const double distance = (place - a - closest_on_segment(place, a, b) * (b - a)).norm();
            if (!(distance < least)) continue;
            least = distance;
            nearest = f;
        }
    return nearest;
}

void Obstacle::find_faces_touching(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<int>& found) const
{
    const Triangle triangle(arris::to_cgal(a), arris::to_cgal(b), arris::to_cgal(c));
    if (!triangle.is_degenerate()) {
        find_in(trees_->faces, triangle, trees_->triangles, found);
        return trees_->add_flat([&](const Triangle& flat) { return touches_side_of(flat, triangle); }, found);
    }
    // A triangle that has collapsed to a line is tested as its three sides.
    std::vector<int> side;
    find_faces_touching(a, b, found);
    for (const auto& [p, q] : {std::pair(b, c), std::pair(c, a)}) {
        find_faces_touching(p, q, side);
        found.insert(found.end(), side.begin(), side.end());
    }
    sort_unique(found);
}

void Obstacle::find_faces_touching(const Vec3& a, const Vec3& b, std::vector<int>& found) const
{
    if (a != b) {
        const Segment segment(arris::to_cgal(a), arris::to_cgal(b));
        find_in(trees_->faces, segment, trees_->triangles, found);
        return trees_->add_flat([&](const Triangle& flat) { return touches_side_of(flat, segment); }, found);
    }
    find_faces(Box3(a, a), found);
    std::erase_if(found, [&](int f) {
        const Triangle& triangle = trees_->triangles[f];
        const Kernel::Point_3 point = arris::to_cgal(a);
        return triangle.is_degenerate() ? !touches_side_of(triangle, point) : !triangle.has_on(point);
    });
}

}  // namespace arris
