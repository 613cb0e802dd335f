// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact/contact_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/closest_point.h"
#include "geometry/obstacle/obstacle_distance.h"
#include "geometry/tolerances.h"

namespace arris {

double touch_distance(const Obstacle& obstacle, double thickness)
{
    const Box3& bounds = obstacle.bounds();
    const double largest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
    return std::max(kOnSurface * thickness, kProductRounding * largest);
}

double longest_reach(const ClothMotion& motion, std::span<const int> vertices, double thickness)
{
    double way = 0.0;
    for (const int v : vertices) way = std::max(way, (motion.end[v] - motion.begin[v]).squaredNorm());
    return kReachThicknesses * thickness + kReachShareOfWay * std::sqrt(way);
}

ObstacleContact make_contact(ContactKind kind, const ClothPoint& cloth_point, int element, const Vec3& normal,
                             const Vec3& point, double least_gap)
{
    ObstacleContact contact{cloth_point, kind, element, normal, point, least_gap};
    // Sort vertices ascending, unused ones last.
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

namespace {

/// Distance at the step's begin between the cloth's element and the obstacle's element. The contact's cloth
/// point alone may have been far away then: on cloth that slides over an edge it arrives along the cloth.
double distance_between_elements(const Obstacle& obstacle, const ContactBegin& begin,
                                 const ObstacleContact& contact)
{
    if (contact.vertices[1] < 0) return std::numeric_limits<double>::infinity();
    std::array<Vec3, 3> cloth;
    for (int i = 0; i < 3; ++i)
        cloth[i] = begin[contact.vertices[i] < 0 ? contact.vertices[0] : contact.vertices[i]];
    const auto from = [&](const Vec3& place) { return (place - contact.point).norm(); };
    if (contact.kind == ContactKind::Edge) {
        const std::vector<Vec3>& points = obstacle.mesh().points;
        const auto& [a, b] = obstacle.topology().edges[contact.element].points;
        const SegmentPair nearest = closest_between_segments({cloth[0], cloth[1]}, {points[a], points[b]});
        return (nearest.first - nearest.second).norm();
    }
    if (contact.vertices[2] < 0) {
        const double s = closest_on_segment(contact.point, cloth[0], cloth[1]);
        return from((1.0 - s) * cloth[0] + s * cloth[1]);
    }
    const Vec3 normal = (cloth[1] - cloth[0]).cross(cloth[2] - cloth[0]).stableNormalized();
    return from(closest_on_triangle(contact.point, cloth, normal).point);
}

}  // namespace

ObstacleContact make_contact(const Obstacle& obstacle, const ClothMotion& motion, const ContactBegin& begin,
                             ContactKind kind, const ClothPoint& cloth_point, int element, const Vec3& normal,
                             const Vec3& point, double thickness)
{
    const Vec3 began = cloth_point.at(begin);
    const double before = normal.dot(began - point);
    const double after = normal.dot(cloth_point.at(motion.end) - point);
    ObstacleContact contact =
        make_contact(kind, cloth_point, element, normal, point, std::min(thickness, before));
    // Cloth that slides along a curved surface approaches this plane from below. Allow it to keep its present
    // distance from the surface.
    if (contact.least_gap < std::min(thickness, after)) {
        const double farthest = std::min(thickness, distance_between_elements(obstacle, begin, contact));
        contact.least_gap =
            std::max(contact.least_gap, std::min(after, distance_to(obstacle, began, farthest)));
    }
    return contact;
}

}  // namespace arris
