// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact/contact_begin.h"

#include "geometry/closest_point.h"

namespace arris {

ContactBegin begin_from_edge(const Obstacle& obstacle, const ClothMotion& motion,
                             const std::array<int, 2>& cloth_edge, int edge)
{
    if (!motion.sides) return ContactBegin(motion);
    const auto& [a, b] = obstacle.topology().edges[edge].points;
    const std::vector<Vec3>& points = motion.sides->obstacle->mesh().points;
    const std::vector<Vec3>& cloth = motion.sides->cloth;
    const double t =
        closest_between_segments({cloth[cloth_edge[0]], cloth[cloth_edge[1]]}, {points[a], points[b]}).t;
    return {obstacle, motion, {SurfaceKind::Edge, edge, {a, b, -1}, {1.0 - t, t, 0.0}}};
}

ContactBegin begin_from_point(const Obstacle& obstacle, const ClothMotion& motion, int point)
{
    if (!motion.sides) return ContactBegin(motion);
    return {obstacle, motion, {SurfaceKind::Point, point, {point, -1, -1}, {1.0, 0.0, 0.0}}};
}

}  // namespace arris
