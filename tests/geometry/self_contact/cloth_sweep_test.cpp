// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/closest_point.h"
#include "geometry/contact/continuous_collision.h"

namespace arris {
namespace {

using Corners = std::array<Vec3, 4>;

Corners at(const Corners& begin, const Corners& end, double time)
{
    Corners now;
    for (int i = 0; i < 4; ++i) now[i] = begin[i] + time * (end[i] - begin[i]);
    return now;
}

double distance(const Corners& x, bool is_vertex)
{
    if (is_vertex) {
        const Vec3 normal = (x[2] - x[1]).cross(x[3] - x[1]).stableNormalized();
        return (x[0] - closest_on_triangle(x[0], {x[1], x[2], x[3]}, normal).point).norm();
    }
    const SegmentPair pair = closest_between_segments({x[0], x[1]}, {x[2], x[3]});
    return (pair.first - pair.second).norm();
}

/// Greatest speed of any point of one element against the other: the distance changes no faster.
double relative_speed(const Corners& begin, const Corners& end, bool is_vertex)
{
    const int first = is_vertex ? 1 : 2;
    double fastest = 0.0;
    for (int i = 0; i < first; ++i)
        for (int k = first; k < 4; ++k)
            fastest = std::max(fastest, (end[i] - begin[i] - (end[k] - begin[k])).norm());
    return fastest;
}

/// Time at which the distance falls to `least`, by steps that are too short to pass it; 2 where it never
/// does.
double find_approach(const Corners& begin, const Corners& end, bool is_vertex, double least)
{
    const double speed = relative_speed(begin, end, is_vertex);
    double time = 0.0;
    for (int step = 0; step < 200000 && time <= 1.0; ++step) {
        const double now = distance(at(begin, end, time), is_vertex);
        if (now <= least) return time;
        if (!(speed > 0.0)) return 2.0;
        time += std::max(now / speed, 1e-7);
    }
    return 2.0;
}

std::optional<ClothSweepHit> sweep(const Corners& begin, const Corners& end, bool is_vertex, double distance)
{
    return is_vertex ? sweep_cloth_vertex_face(begin, end, distance)
                     : sweep_cloth_edges(begin, end, distance);
}

/// Random motions: small, large, flat, along an axis, of equal points.
struct RandomMotion {
    std::mt19937 random;

    Vec3 vector(double size)
    {
        std::uniform_real_distribution<double> uniform(-size, size);
        return {uniform(random), uniform(random), uniform(random)};
    }
    void make(int k, Corners& begin, Corners& end)
    {
        const double way = std::pow(10.0, -(k % 4));
        const Vec3 common = vector(1.0);
        for (int i = 0; i < 4; ++i) {
            begin[i] = vector(1.0);
            end[i] = begin[i] + common + vector(way);
            if (k % 5 == 1) begin[i].z() = end[i].z() = 0.0;
            if (k % 5 == 2) end[i] = begin[i] + Vec3(0.0, 0.0, vector(2.0).x());
            if (k % 7 == 3 && i > 0) end[i] = begin[i];
        }
        if (k % 11 == 4) begin[3] = begin[2];
    }
};

TEST(ClothSweep, ReportsEveryTouchAndNoOther)
{
    constexpr double kDistance = 1e-6, kClear = 1e-4;
    RandomMotion motion{std::mt19937(7)};
    int touched = 0;
    for (int k = 0; k < 20000; ++k) {
        const bool is_vertex = k % 2 == 0;
        Corners begin, end;
        motion.make(k / 2, begin, end);
        if (distance(begin, is_vertex) < 1e-3) continue;
        const auto hit = sweep(begin, end, is_vertex, kDistance);
        const double near = find_approach(begin, end, is_vertex, 0.5 * kDistance);
        if (near <= 1.0) {
            ++touched;
            ASSERT_TRUE(hit) << k << " " << near;
            EXPECT_LE(hit->time, near + 1e-3) << k;
        }
        if (!hit) continue;
        EXPECT_LT(distance(at(begin, end, hit->time), is_vertex), kClear) << k;
        // The weights are those of the meeting points, and the normal points from the second to the first.
        const Corners met = at(begin, end, hit->time), before = at(begin, end, 0.999 * hit->time);
        Vec3 gap = Vec3::Zero();
        double first = 0.0, sum = 0.0, apart = 0.0;
        for (int i = 0; i < 4; ++i) {
            gap += hit->weights[i] * met[i];
            sum += hit->weights[i];
            first += std::max(hit->weights[i], 0.0);
            apart += hit->weights[i] * hit->normal.dot(before[i]);
        }
        EXPECT_LT(gap.norm(), kClear) << k;
        EXPECT_NEAR(sum, 0.0, 1e-12) << k;
        EXPECT_NEAR(first, 1.0, 1e-12) << k;
        EXPECT_GT(apart, -1e-5) << k;
    }
    EXPECT_GT(touched, 800);
}

TEST(ClothSweep, PairsThatMoveAlikeNeverMeet)
{
    RandomMotion motion{std::mt19937(3)};
    for (int k = 0; k < 1000; ++k) {
        Corners begin, end;
        motion.make(4 * k, begin, end);
        const Vec3 way = motion.vector(100.0);
        for (int i = 0; i < 4; ++i) end[i] = begin[i] + way;
        for (const bool is_vertex : {true, false})
            EXPECT_FALSE(distance(begin, is_vertex) > 1e-9 && sweep(begin, end, is_vertex, 1e-12))
                << k << " " << is_vertex;
    }
}

}  // namespace
}  // namespace arris
