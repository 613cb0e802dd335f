// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/border_seams.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

// Widest seam, relative to the mesh's diagonal.
constexpr double kWidest = 5e-4;

// Widest seam relative to its edge: short edges are near each other where nothing is to be joined.
constexpr double kWidestOfEdge = 0.05;

struct BorderEdge {
    std::array<int, 2> points;
    Vec3 a, b;
};

// The smaller of the two ways to pair the ends: the greater distance of its two pairs.
double distance(const BorderEdge& e, const BorderEdge& f)
{
    return std::min(std::max((e.a - f.a).norm(), (e.b - f.b).norm()),
                    std::max((e.a - f.b).norm(), (e.b - f.a).norm()));
}

bool share_points(const BorderEdge& e, const BorderEdge& f)
{
    return std::find_first_of(e.points.begin(), e.points.end(), f.points.begin(), f.points.end()) !=
           e.points.end();
}

}  // namespace

BorderSeams find_border_seams(const ObstacleMesh& mesh, const ObstacleTopology& topology)
{
    Eigen::AlignedBox3d bounds;
    for (const Vec3& p : mesh.points) bounds.extend(p);
    if (bounds.isEmpty()) return {};
    const double size = bounds.diagonal().stableNorm();
    std::vector<BorderEdge> edges;
    std::vector<BoxTree::Box> middles;
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        if (topology.edges[e].faces[1] >= 0) continue;
        const auto& [a, b] = topology.edges[e].points;
        edges.push_back({topology.edges[e].points, mesh.points[a], mesh.points[b]});
        middles.emplace_back(0.5 * (mesh.points[a] + mesh.points[b]));
    }
    const BoxTree tree(middles);
    BorderSeams seams;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        double nearest = std::numeric_limits<double>::infinity();
        const double width = std::min(kWidest * size, kWidestOfEdge * (edges[e].b - edges[e].a).norm());
        const Vec3 reach = Vec3::Constant(width);
        tree.visit(BoxTree::Box(middles[e].min() - reach, middles[e].max() + reach), [&](int f) {
            if (static_cast<int>(e) != f && !share_points(edges[e], edges[f]))
                nearest = std::min(nearest, distance(edges[e], edges[f]));
        });
        // Nearer points are welded; where they are not, the repair has split a vertex, and says so.
        if (nearest > width || nearest <= kSinglePrecision * size) continue;
        if (seams.edges++ == 0) seams.place = middles[e].min();
        seams.widest = std::max(seams.widest, nearest);
    }
    return seams;
}

}  // namespace arris
