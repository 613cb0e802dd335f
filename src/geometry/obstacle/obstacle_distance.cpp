// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_distance.h"

#include <algorithm>

#include "geometry/closest_point.h"

namespace arris {

double distance_to(const Obstacle& obstacle, const Vec3& place, double most)
{
    const std::vector<Vec3>& points = obstacle.mesh().points;
    const ObstacleTopology& topology = obstacle.topology();
    const Box3 box(place.array() - most, place.array() + most);
    double least = most;
    const auto take = [&](const Vec3& nearest) { least = std::min(least, (place - nearest).norm()); };
    std::vector<int> near;
    obstacle.find_faces(box, near);
    for (const int f : near) {
        const auto& [a, b, c] = obstacle.mesh().faces[f];
        take(closest_on_triangle(place, {points[a], points[b], points[c]}, topology.face_normals[f]).point);
    }
    obstacle.find_feature_edges(box, near);
    for (const int f : near) {
        const auto& [a, b] = topology.edges[obstacle.features().edges[f].edge].points;
        take(points[a] + closest_on_segment(place, points[a], points[b]) * (points[b] - points[a]));
    }
    obstacle.find_corners(box, near);
    for (const int c : near) take(points[obstacle.features().corners[c].point]);
    return least;
}

}  // namespace arris
