// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {

double touch_distance(const Obstacle& obstacle, double thickness)
{
    constexpr double kShare = 1e-6;
    constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
    const Box3& bounds = obstacle.bounds();
    const double largest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
    return std::max(kShare * thickness, kRounding * largest);
}

double longest_reach(const ClothMotion& motion, std::span<const int> vertices, double thickness)
{
    double way = 0.0;
    for (const int v : vertices) way = std::max(way, (motion.end[v] - motion.begin[v]).squaredNorm());
    return kReachThicknesses * thickness + kReachShareOfWay * std::sqrt(way);
}

ObstacleContact make_contact(const ClothMotion& motion, ContactKind kind, const ClothPoint& cloth_point,
                             int element, const Vec3& normal, const Vec3& point, double thickness)
{
    const Vec3 from = cloth_point.at(motion.begin) - point;
    const double before = normal.dot(from);
    const double after = normal.dot(cloth_point.at(motion.end) - point);
    // What slides along a curved surface comes to this plane from below it.
    const double sliding = std::min(after, from.norm());
    ObstacleContact contact{cloth_point, kind,  element,
                            normal,      point, std::min(thickness, std::max(before, sliding))};
    // Ascending, unused ones last.
    const auto swap_if = [&](int i, int j) {
        const int a = contact.vertices[i], b = contact.vertices[j];
        if (b < 0 || (a >= 0 && a < b)) return;
        std::swap(contact.vertices[i], contact.vertices[j]);
        std::swap(contact.weights[i], contact.weights[j]);
    };
    swap_if(0, 1);
    swap_if(1, 2);
    swap_if(0, 1);
    return contact;
}

}  // namespace arris
