// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/feature_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;  // for sums of lengths of about 1 m

Obstacle make_polyline(const std::vector<Vec3>& points, bool is_closed)
{
    return samples::make_obstacle(samples::wire(points, is_closed));
}

Obstacle make_polygon(int count)
{
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k)
        points.emplace_back(std::cos(2.0 * M_PI * k / count), std::sin(2.0 * M_PI * k / count), 0.0);
    return make_polyline(points, true);
}

/// A wire with a small bend at (1, 0, 0), and ends at (0, 0, 0) and (3, .1, 0).
Obstacle make_bent()
{
    return make_polyline({{0, 0, 0}, {1, 0, 0}, {2, 0.1, 0}, {3, 0.1, 0}}, false);
}

TEST(FollowPolyline, GoesOnPastNodesButNotPastCorners)
{
    const Obstacle wire = make_bent();
    for (const auto& [x, feature] : {std::pair(-1.0, 0), {0.2, 0}, {1.3, 1}, {2.5, 2}, {7.0, 2}}) {
        const FeaturePlace place = follow_polyline(wire, 0, Vec3(x, 0.05, 0.01));
        EXPECT_EQ(place.feature, feature) << x;
        EXPECT_EQ(place.s <= 0.0, x < 0.0);
        EXPECT_EQ(place.s >= 1.0, x > 3.0);
    }
    const Obstacle right = make_polyline({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, false);
    EXPECT_EQ(follow_polyline(right, 0, Vec3(1, 0.5, 0)).feature, 0) << "it ends at the corner";
}

TEST(PastEnd, IsWhatIsNearestToACornerNotToANode)
{
    const Obstacle wire = make_bent();
    EXPECT_TRUE(is_past_end(wire, 0, Vec3(-0.3, 0.05, 0.4)));
    EXPECT_TRUE(is_past_end(wire, 2, Vec3(3.2, 0.0, -0.1)));
    for (const int feature : {0, 1, 2})
        EXPECT_FALSE(is_past_end(wire, feature, Vec3(feature + 0.5, 0.2, 0.1)));
    EXPECT_FALSE(is_past_end(wire, 0, Vec3(1.5, 0.0, 0.0))) << "the polyline goes on";
    EXPECT_FALSE(is_past_end(make_polygon(12), 0, Vec3(5.0, -5.0, 0.0))) << "and has no end";
}

TEST(LengthPastEnd, IsAlongTheLineThatGoesOnFromTheEnd)
{
    const Obstacle wire = make_polyline({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}}, false);
    constexpr double kRounding = 1e-14;
    EXPECT_NEAR(length_past_end(wire, 0, Vec3(-0.3, 0.05, 0.4)), 0.3, kRounding);
    EXPECT_NEAR(length_past_end(wire, 1, Vec3(4.0, 2.0, 0.7)), std::sqrt(2.0), kRounding);
    for (const Vec3& place : {Vec3(0.0, 0.1, 0.0), Vec3(1.0, 0.1, 0.0), Vec3(2.5, -0.5, 0.0)})
        EXPECT_NEAR(length_past_end(wire, 0, place), 0.0, kRounding) << place.transpose();
    EXPECT_EQ(end_passed(wire, 0, Vec3(-0.3, 0.0, 0.0)), 0);
    EXPECT_EQ(end_passed(wire, 1, Vec3(4.0, 2.0, 0.0)), 2);
    EXPECT_EQ(end_passed(wire, 0, Vec3(0.5, 0.0, 0.0)), -1);
    EXPECT_NEAR((way_across(wire, 0, Vec3(-0.3, 0.05, 0.4)) - Vec3(0.0, 0.05, 0.4)).norm(), 0.0, kRounding);
}

TEST(FollowPolyline, ExactlyAtANodeStaysWhereItWas)
{
    const Obstacle wire = make_bent();
    EXPECT_EQ(follow_polyline(wire, 0, Vec3(1, 0, 0)).feature, 0);
    EXPECT_EQ(follow_polyline(wire, 1, Vec3(1, 0, 0)).feature, 1);
}

TEST(FollowPolyline, DoesNotJumpToAStrandNearby)
{
    // A hairpin: the second leg is 1 mm beside the first.
    std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}};
    for (int k = 1; k < 8; ++k)
        points.emplace_back(1.0 + 5e-4 * std::sin(M_PI * k / 8), 5e-4 * (1.0 - std::cos(M_PI * k / 8)), 0.0);
    points.emplace_back(1, 1e-3, 0);
    points.emplace_back(0, 1e-3, 0);
    const Obstacle hairpin = make_polyline(points, false);
    EXPECT_EQ(hairpin.features().polylines.size(), 1u);
    EXPECT_EQ(follow_polyline(hairpin, 0, Vec3(0.5, 9e-4, 0)).feature, 0);
}

TEST(FindBend, IsWhereAWireGoesOnElsewhereButNoCorner)
{
    const Obstacle wire = make_bent();
    for (const auto& [point, is_wire_bend] : {std::pair(0, false), {1, true}, {2, true}, {3, false}})
        EXPECT_EQ(find_bend(wire, point).has_value(), is_wire_bend) << point;
    const FeatureBend first = *find_bend(wire, 1);
    EXPECT_EQ(bend_point(wire, first), Vec3(1, 0, 0));
    const Vec3 halfway = (Vec3::UnitX() + Vec3(1, 0.1, 0).normalized()).normalized();
    EXPECT_LT((tangent_at(wire, first) - halfway).norm(), kRoundOff);
    const Obstacle right = make_polyline({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, false);
    EXPECT_FALSE(find_bend(right, 1)) << "a corner";
    const Obstacle straight = make_polyline({{0, 0, 0}, {1, 0, 0}, {2, 0.017, 0}}, false);
    EXPECT_FALSE(find_bend(straight, 1)) << "less than a degree";
    const Obstacle box = samples::make_obstacle(samples::box({-1, -1, -1}, {1, 1, 1}));
    EXPECT_FALSE(find_bend(box, 0)) << "no wire";
}

TEST(FindBend, HasATangentAlongItsEdgeWhicheverWayTheOthersRun)
{
    // The last edge of a loop begins where the first one does.
    for (const int count : {8, 24}) {
        const Obstacle loop = make_polygon(count);
        for (int point = 0; point < count; ++point) {
            const std::optional<FeatureBend> turn = find_bend(loop, point);
            ASSERT_TRUE(turn) << point;
            const Vec3& at = loop.mesh().points[point];
            EXPECT_EQ(bend_point(loop, *turn), at);
            const Vec3 tangent = tangent_at(loop, *turn);
            EXPECT_NEAR(std::abs(tangent.dot(Vec3::UnitZ().cross(at))), 1.0, kRoundOff) << point;
            const auto& ends = loop.topology().edges[loop.features().edges[turn->feature].edge].points;
            EXPECT_GT(tangent.dot(loop.mesh().points[ends[1]] - loop.mesh().points[ends[0]]), 0.0);
        }
    }
}

TEST(MissedByChord, IsTheHeightOfTheTurnOverItWhereBothEdgesAreAsLong)
{
    for (const double degrees : {2.0, 15.0, 50.0}) {
        const double turn = degrees * M_PI / 180.0;
        const Vec3 onward(std::cos(turn), std::sin(turn), 0);
        const Obstacle wire = make_polyline({{-1, 0, 0}, {0, 0, 0}, 0.5 * onward, 2.0 * onward}, false);
        const FeatureBend at = *find_bend(wire, 1);
        for (const double reach : {0.1, 0.5}) {
            const Vec3 middle = 0.5 * reach * (onward - Vec3::UnitX());
            EXPECT_NEAR(missed_by_chord(wire, at, reach), middle.norm(), kRoundOff) << degrees;
        }
        EXPECT_EQ(missed_by_chord(wire, at, 0.51), 0.0) << "the edge after it is shorter";
    }
    // A circle of short edges is a smooth curve for a long reach.
    EXPECT_EQ(missed_by_chord(make_polygon(200), *find_bend(make_polygon(200), 7), 0.05), 0.0);
}

TEST(DistanceAlong, GoesTheShorterWayAroundALoop)
{
    const Obstacle loop = make_polygon(30);
    const double side = 2.0 * std::sin(M_PI / 30.0);
    const Polyline polyline = trace_polyline(loop, 0);
    ASSERT_TRUE(polyline.is_closed);
    ASSERT_EQ(polyline.edges.size(), 30u);
    EXPECT_NEAR(polyline.length, 30.0 * side, kRoundOff);
    for (const int from : {0, 11, 29})
        for (const int by : {0, 1, 2, 14, 16, 29}) {
            const FeaturePlace a{polyline.edges[from].feature, 0.5},
                b{polyline.edges[(from + by) % 30].feature, 0.5};
            const double truth = std::min(by, 30 - by) * side;
            const auto found = distance_along(loop, a, b, 20.0 * side);
            ASSERT_TRUE(found) << from << ' ' << by;
            EXPECT_NEAR(*found, truth, kRoundOff);
            if (by > 0) {
                EXPECT_FALSE(distance_along(loop, a, b, 0.99 * truth));
            }
        }
}

TEST(DistanceAlong, EndsAtCornersAndKnowsThem)
{
    const Obstacle right = make_polyline({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, false);
    EXPECT_FALSE(distance_along(right, {0, 0.5}, {1, 0.5}, 10.0));
    int corner = 0;
    while (right.features().corners[corner].point != 1) ++corner;
    for (const int feature : {0, 1}) {
        const auto found = distance_to_corner(right, {feature, 0.3}, corner, 10.0);
        const auto& ends = right.topology().edges[right.features().edges[feature].edge].points;
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, ends[0] == 1 ? 0.3 : 0.7, kRoundOff);
        EXPECT_FALSE(distance_to_corner(right, {feature, 0.3}, corner, 0.2));
    }
}

TEST(TracePolyline, BeginsAtAnEndAndCoversIt)
{
    const Obstacle wire = make_bent();
    const Polyline polyline = trace_polyline(wire, 0);
    EXPECT_FALSE(polyline.is_closed);
    ASSERT_EQ(polyline.edges.size(), 3u);
    EXPECT_NEAR(polyline.length, 2.0 + std::hypot(1.0, 0.1), kRoundOff);
    EXPECT_EQ(polyline.edges[0].begin, 0.0);
    EXPECT_NEAR(polyline.edges[1].begin, 1.0, kRoundOff);
    EXPECT_TRUE(trace_polyline(wire, 5).edges.empty());
}

}  // namespace
}  // namespace arris
