// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/closest_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace arris {
namespace {

// Tolerance for scalar products of differences, relative to the greatest distance squared.
constexpr double kOptimality = 1e-13;

class Random {
  public:
    Vec3 vector(double size) { return {size * number(), size * number(), size * number()}; }
    double number() { return uniform_(engine_); }

  private:
    std::mt19937 engine_{20260101};
    std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

// The nearest point q of a convex set to y is in the set and satisfies (y - q) . (p - q) <= 0 for all points
// p of the set.
void expect_nearest(const Vec3& y, const Vec3& q, const std::vector<Vec3>& corners, double slack)
{
    double scale = 0.0;
    for (const Vec3& p : corners) scale = std::max(scale, (p - y).squaredNorm());
    for (const Vec3& p : corners) EXPECT_LE((y - q).dot(p - q), slack * scale);
}

void expect_on_triangle(const Vec3& y, const std::array<Vec3, 3>& t, double slack)
{
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized();
    const PointOnTriangle found = closest_on_triangle(y, t, normal);
    expect_nearest(y, found.point, {t[0], t[1], t[2]}, slack);
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        EXPECT_GE(found.weights[i], 0.0);
        sum += found.weights[i] * (t[i] - t[0]);
    }
    double size = 0.0;
    for (const Vec3& p : t) size = std::max(size, (p - y).norm());
    EXPECT_LE((sum - (found.point - t[0])).norm(), std::sqrt(slack) * 1e-2 * size);
    EXPECT_NEAR(found.weights[0] + found.weights[1] + found.weights[2], 1.0, 1e-14);
    if (found.corner >= 0) {
        EXPECT_EQ(found.point, t[found.corner]);
    }
    if (found.edge >= 0) {
        EXPECT_EQ(found.weights[(found.edge + 2) % 3], 0.0);
    }
}

TEST(ClosestOnTriangle, IsOptimalInEveryRegion)
{
    Random random;
    for (int k = 0; k < 20000; ++k) {
        const double size = std::pow(10.0, 6.0 * random.number());
        const std::array<Vec3, 3> t = {random.vector(size), random.vector(size), random.vector(size)};
        expect_on_triangle(random.vector(2.0 * size), t, kOptimality);
        for (int i = 0; i < 3; ++i) {
            expect_on_triangle(t[i], t, kOptimality);
            expect_on_triangle(0.5 * (t[i] + t[(i + 1) % 3]), t, kOptimality);
        }
    }
}

TEST(ClosestOnTriangle, IsOptimalOnSliversAndFarAway)
{
    Random random;
    for (int k = 0; k < 5000; ++k) {
        const Vec3 a = random.vector(1.0), b = random.vector(1.0);
        const std::array<Vec3, 3> sliver = {a, b, 0.5 * (a + b) + random.vector(1e-6)};
        expect_on_triangle(random.vector(1.0), sliver, 1e-9);  // the sliver's normal is accurate to 1e-10
        const Vec3 far(1e6, -1e6, 1e6);
        // Coordinates are accurate to 1e-10.
        expect_on_triangle(far + random.vector(2.0), {far + a, far + b, far + random.vector(1.0)}, 1e-9);
    }
}

TEST(ClosestOnTriangle, WithoutAreaIsNearestOnItsEdges)
{
    const std::array<Vec3, 3> line = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 0)};
    EXPECT_EQ(closest_on_triangle({0.5, 1, 0}, line, Vec3::Zero()).point, Vec3(0.5, 0, 0));
    const std::array<Vec3, 3> point = {Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)};
    EXPECT_EQ(closest_on_triangle({0.5, 1, 0}, point, Vec3::Zero()).point, Vec3(1, 1, 1));
}

void expect_between(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b, double slack)
{
    const SegmentPair found = closest_between_segments(a, b);
    expect_nearest(found.second, found.first, {a[0], a[1]}, slack);
    expect_nearest(found.first, found.second, {b[0], b[1]}, slack);
    const double size = std::max((a[0] - b[0]).norm(), (a[1] - b[1]).norm()) + (a[1] - a[0]).norm();
    EXPECT_LE((a[0] + found.s * (a[1] - a[0]) - found.first).norm(), 1e-12 * size);
    EXPECT_LE((b[0] + found.t * (b[1] - b[0]) - found.second).norm(), 1e-12 * size);
}

TEST(ClosestBetweenSegments, IsOptimal)
{
    Random random;
    for (int k = 0; k < 20000; ++k) {
        const double size = std::pow(10.0, 6.0 * random.number());
        const std::array<Vec3, 2> a = {random.vector(size), random.vector(size)};
        expect_between(a, {random.vector(size), random.vector(size)}, kOptimality);
        expect_between(a, {a[1], random.vector(size)}, kOptimality);
        expect_between(a, a, kOptimality);
        const Vec3 shift = random.vector(size);  // deviation from parallel, 1e-2 .. 1e-14
        const Vec3 bend = random.vector(size * std::pow(10.0, -8.0 + 6.0 * random.number()));
        expect_between(a, {a[0] + shift, a[1] + shift + bend}, 1e-10);
        expect_between(a, {a[0] + shift, a[0] + shift}, kOptimality);  // segments of length 0
    }
}

TEST(ClosestBetweenSegments, KnowsItsEnds)
{
    const SegmentPair found =
        closest_between_segments({Vec3(0, 0, 0), Vec3(1, 0, 0)}, {Vec3(2, 1, 0), Vec3(2, 1, 5)});
    EXPECT_EQ(found.s, 1.0);
    EXPECT_EQ(found.t, 0.0);
}

}  // namespace
}  // namespace arris
