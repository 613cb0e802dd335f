// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace arris {
namespace {

// Squared sine below which the crossing of two lines is inaccurate, so that segment ends are tried as well.
constexpr double kNearlyParallel = 1e-6;

PointOnTriangle on_edge(const Vec3& place, const std::array<Vec3, 3>& triangle, int edge)
{
    const int next = (edge + 1) % 3;
    const double t = closest_on_segment(place, triangle[edge], triangle[next]);
    PointOnTriangle found;
    found.weights = {0.0, 0.0, 0.0};
    found.weights[edge] = 1.0 - t;
    found.weights[next] = t;
    if (t > 0.0 && t < 1.0) {
        found.edge = edge;
        found.point = triangle[edge] + t * (triangle[next] - triangle[edge]);
    } else {
        found.corner = t > 0.0 ? next : edge;
        found.point = triangle[found.corner];
    }
    return found;
}

}  // namespace

PointOnTriangle closest_on_triangle(const Vec3& place, const std::array<Vec3, 3>& triangle,
                                    const Vec3& normal)
{
    // Twice the signed area between each edge and the projected point: the opposite corner's weight,
    // unscaled.
    std::array<double, 3> side;
    for (int i = 0; i < 3; ++i)
        side[i] = normal.cross(triangle[(i + 1) % 3] - triangle[i]).dot(place - triangle[i]);
    if (side[0] > 0.0 && side[1] > 0.0 && side[2] > 0.0) {
        const double sum = side[0] + side[1] + side[2];
        PointOnTriangle inside;
        inside.point = place - normal.dot(place - triangle[0]) * normal;
        inside.weights = {side[1] / sum, side[2] / sum, side[0] / sum};
        return inside;
    }
    // Outside the triangle, only edges that face `place` can hold the nearest point.
    PointOnTriangle best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        if (side[i] > 0.0) continue;
        const PointOnTriangle found = on_edge(place, triangle, i);
        const double squared_distance = (place - found.point).squaredNorm();
        if (squared_distance < least) {
            least = squared_distance;
            best = found;
        }
    }
    return best;
}

double closest_on_segment(const Vec3& place, const Vec3& a, const Vec3& b)
{
    const Vec3 along = b - a;
    const double squared_length = along.squaredNorm();
    if (!(squared_length > 0.0)) return 0.0;
    // Measured from the nearer end, so that near an end the parameter has that end's precision.
    const double t = along.dot(place - a) / squared_length;
    if (t <= 0.5) return std::max(t, 0.0);
    return std::clamp(1.0 + along.dot(place - b) / squared_length, 0.0, 1.0);
}

SegmentPair closest_between_segments(const std::array<Vec3, 2>& first, const std::array<Vec3, 2>& second)
{
    const Vec3 d = first[1] - first[0], e = second[1] - second[0], across = second[0] - first[0];
    SegmentPair best{};
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](double s, const Vec3& p, double t, const Vec3& q) {
        const double squared_distance = (p - q).squaredNorm();
        if (!(squared_distance < least)) return;
        least = squared_distance;
        best = {s, t, p, q};
    };
    const Vec3 normal = d.cross(e);  // no cancellation as in d.d e.e - (d.e)^2
    const double squared = normal.squaredNorm();
    if (squared > 0.0) {
        const double s = across.cross(e).dot(normal) / squared, t = across.cross(d).dot(normal) / squared;
        if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
            offer(s, first[0] + s * d, t, second[0] + t * e);
            if (squared > kNearlyParallel * d.squaredNorm() * e.squaredNorm()) return best;
        }
    }
    for (int i = 0; i < 2; ++i) {
        const double t = closest_on_segment(first[i], second[0], second[1]);
        offer(i, first[i], t, t < 1.0 ? Vec3(second[0] + t * e) : second[1]);
        const double s = closest_on_segment(second[i], first[0], first[1]);
        offer(s, s < 1.0 ? Vec3(first[0] + s * d) : first[1], i, second[i]);
    }
    return best;
}

}  // namespace arris
