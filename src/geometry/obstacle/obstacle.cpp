// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Triangle_3.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <utility>

#include "geometry/cgal.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using FaceTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>>>;
using SegmentTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_segment_primitive<Kernel, std::vector<Segment>::const_iterator>>>;

/// Writes the indices of the primitives that a query intersects, ascending.
template <typename Tree, typename Query, typename Items>
void find_in(const Tree& tree, const Query& query, const Items& items, std::vector<int>& found)
{
    found.clear();
    if (items.empty()) return;
    std::vector<typename Tree::Primitive_id> ids;
    tree.all_intersected_primitives(query, std::back_inserter(ids));
    for (const auto& id : ids) found.push_back(static_cast<int>(id - items.begin()));
    std::sort(found.begin(), found.end());
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
    std::vector<Vec3> corners;
    std::vector<int> corners_by_x;  ///< corner indices sorted by x; a list suffices, as corners are few

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
        // Build now: a tree that builds itself at its first query does so under a lock.
        faces.insert(triangles.cbegin(), triangles.cend());
        if (!triangles.empty()) faces.build();
        edges.insert(feature_edges.cbegin(), feature_edges.cend());
        if (!feature_edges.empty()) edges.build();

        for (const FeatureCorner& corner : features.corners) corners.push_back(mesh.points[corner.point]);
        corners_by_x.resize(corners.size());
        std::iota(corners_by_x.begin(), corners_by_x.end(), 0);
        std::sort(corners_by_x.begin(), corners_by_x.end(),
                  [&](int i, int j) { return std::pair(corners[i].x(), i) < std::pair(corners[j].x(), j); });
    }
};

Obstacle::Obstacle(ObstacleMesh mesh, double feature_angle)
    : mesh_(std::move(mesh)),
      topology_(make_topology(mesh_)),
      features_(find_features(mesh_, topology_, feature_angle)),
      bounds_(box_of(mesh_)),
      trees_(std::make_unique<Trees>(mesh_, topology_, features_))
{
    assert(validate(mesh_).empty());
}

Obstacle::~Obstacle() = default;
Obstacle::Obstacle(Obstacle&&) noexcept = default;
Obstacle& Obstacle::operator=(Obstacle&&) noexcept = default;

void Obstacle::find_faces(const Box3& box, std::vector<int>& found) const
{
    found.clear();
    if (box.intersects(bounds_)) find_in(trees_->faces, to_cgal(box), trees_->triangles, found);
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

void Obstacle::find_faces_touching(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<int>& found) const
{
    const Triangle triangle(arris::to_cgal(a), arris::to_cgal(b), arris::to_cgal(c));
    if (!triangle.is_degenerate()) return find_in(trees_->faces, triangle, trees_->triangles, found);
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
    if (a != b)
        return find_in(trees_->faces, Segment(arris::to_cgal(a), arris::to_cgal(b)), trees_->triangles,
                       found);
    find_faces(Box3(a, a), found);
    std::erase_if(found, [&](int f) { return !trees_->triangles[f].has_on(arris::to_cgal(a)); });
}

}  // namespace arris
