// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/feature_nodes.h"

#include <algorithm>

#include "geometry/tolerances.h"

namespace arris {
namespace {

}  // namespace

int corner_at(const ObstacleFeatures& features, int point)
{
    const auto found = std::lower_bound(features.corners.begin(), features.corners.end(), point,
                                        [](const FeatureCorner& c, int p) { return c.point < p; });
    return found != features.corners.end() && found->point == point
               ? static_cast<int>(found - features.corners.begin())
               : -1;
}

bool is_corner(const ObstacleFeatures& features, int point)
{
    return corner_at(features, point) >= 0;
}

bool is_tip(const Obstacle& obstacle, int corner)
{
    return obstacle.features().corners[corner].normals.empty();
}

std::vector<FeatureNode> find_feature_nodes(const Obstacle& obstacle)
{
    const ObstacleFeatures& features = obstacle.features();
    const std::vector<Vec3>& points = obstacle.mesh().points;
    std::vector<FeatureNode> nodes;
    for (const FeatureCorner& corner : features.corners) nodes.push_back({corner.point, true, {}, {}});

    // Both directed copies of each feature edge: the point it leaves and the point it leads to.
    std::vector<std::array<int, 2>> ends;
    for (const FeatureEdge& feature : features.edges) {
        const auto& [a, b] = obstacle.topology().edges[feature.edge].points;
        ends.push_back({a, b});
        ends.push_back({b, a});
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const int point = ends[i][0];
        const bool is_pair = ends[i + 1][0] == point && (i == 0 || ends[i - 1][0] != point) &&
                             (i + 2 == ends.size() || ends[i + 2][0] != point);
        if (!is_pair) continue;
        if (is_corner(features, point)) continue;
        const Vec3 first = (points[ends[i][1]] - points[point]).normalized();
        const Vec3 second = (points[ends[i + 1][1]] - points[point]).normalized();
        if (first.cross(second).norm() > kStraight)
            nodes.push_back({point, false, {ends[i][1], ends[i + 1][1]}, {first, second}});
    }
    std::sort(nodes.begin(), nodes.end(),
              [](const FeatureNode& a, const FeatureNode& b) { return a.point < b.point; });
    return nodes;
}

}  // namespace arris
