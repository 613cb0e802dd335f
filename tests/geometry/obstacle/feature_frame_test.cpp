// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/feature_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/middle_direction.h"
#include "geometry/obstacle/normal_cone.h"
#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;
const ClothAround kNoCloth = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};

int find_edge(const Obstacle& obstacle, const Vec3& middle)
{
    const auto& edges = obstacle.features().edges;
    for (std::size_t f = 0; f < edges.size(); ++f) {
        const auto& [a, b] = obstacle.topology().edges[edges[f].edge].points;
        const Vec3 here = 0.5 * (obstacle.mesh().points[a] + obstacle.mesh().points[b]);
        if ((here - middle).norm() < 1e-9) return static_cast<int>(f);
    }
    return -1;
}

int find_corner(const Obstacle& obstacle, const Vec3& place)
{
    const auto& corners = obstacle.features().corners;
    for (std::size_t c = 0; c < corners.size(); ++c)
        if ((obstacle.mesh().points[corners[c].point] - place).norm() < 1e-9) return static_cast<int>(c);
    return -1;
}

/// A wedge along y. Its tip at the origin points up, and its sides are `half_angle` from straight down.
Obstacle wedge(double half_angle)
{
    const double x = std::tan(half_angle);
    return samples::make_obstacle(samples::moved(samples::prism({{-x, -1}, {x, -1}, {0, 0}}, {0, 1}),
                                                 [](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); }));
}

TEST(FeatureFrame, OfABoxEdgeIsTheBisector)
{
    const Obstacle box = samples::make_obstacle(samples::box(Vec3(0, 0, 0), Vec3(2, 2, 2)));
    const int edge = find_edge(box, Vec3(2, 1, 2));
    ASSERT_GE(edge, 0);
    const auto frame = find_edge_frame(box, edge, Vec3(2.1, 0.5, 2.1), kNoCloth);
    ASSERT_TRUE(frame);
    EXPECT_NEAR((frame->point - Vec3(2, 0.5, 2)).norm(), 0.0, kRoundOff);
    EXPECT_NEAR(std::abs(frame->tangent.y()), 1.0, kRoundOff);
    EXPECT_NEAR((frame->outward - Vec3(1, 0, 1).normalized()).norm(), 0.0, kRoundOff);
    EXPECT_NEAR(frame->mitre, std::sqrt(2.0), kRoundOff);
}

TEST(FeatureFrame, OfAKnifeStaysWellDefined)
{
    for (const double half : {0.5, 1e-1, 1e-3, 1e-6}) {
        const Obstacle knife = wedge(half);
        const int edge = find_edge(knife, Vec3(0, -0.5, 0));
        ASSERT_GE(edge, 0) << half;
        const auto frame = find_edge_frame(knife, edge, Vec3(0, -0.3, 0.1), kNoCloth);
        ASSERT_TRUE(frame);
        EXPECT_NEAR((frame->outward - Vec3::UnitZ()).norm(), 0.0, 1e-9) << half;
        EXPECT_LE(frame->mitre, 2.0);
        EXPECT_NEAR(frame->mitre, std::min(2.0, 1.0 / std::sin(half)), 1e-6);
    }
}

TEST(FeatureFrame, OfASheetsBorderPointsAwayFromIt)
{
    const Obstacle sheet = samples::make_obstacle(samples::sheet(2, 2, [](int, int) { return 0.0; }));
    const int edge = find_edge(sheet, Vec3(2, 0.5, 0));
    ASSERT_GE(edge, 0);
    const auto frame = find_edge_frame(sheet, edge, Vec3(2, 0.5, 0.01), kNoCloth);
    ASSERT_TRUE(frame);
    EXPECT_NEAR((frame->outward - Vec3::UnitX()).norm(), 0.0, kRoundOff);
    const int corner = find_corner(sheet, Vec3(2, 2, 0));
    ASSERT_GE(corner, 0);
    const auto at_corner = find_corner_frame(sheet, corner, Vec3(2, 2, 0.01), kNoCloth);
    ASSERT_TRUE(at_corner);
    EXPECT_NEAR((at_corner->outward - Vec3(1, 1, 0).normalized()).norm(), 0.0, kRoundOff);
}

TEST(FeatureFrame, OfASheetsRidgePointsToItsConvexSideWhicheverWayItsFacesTurn)
{
    for (const bool is_reversed : {false, true}) {
        ObstacleMesh roof = samples::sheet(2, 1, [](int i, int) { return i == 1 ? 1.0 : 0.0; });
        if (is_reversed) roof = samples::inside_out(roof);
        const Obstacle obstacle = samples::make_obstacle(roof);
        const int edge = find_edge(obstacle, Vec3(1, 0.5, 1));
        ASSERT_GE(edge, 0);
        const auto frame = find_edge_frame(obstacle, edge, Vec3(1, 0.5, 1.1), kNoCloth);
        ASSERT_TRUE(frame);
        EXPECT_NEAR((frame->outward - Vec3::UnitZ()).norm(), 0.0, kRoundOff);
    }
}

TEST(FeatureFrame, OfAWireFollowsTheClothAtEveryTurn)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    for (double turn = 0.0; turn <= 180.0; turn += 10.0) {
        const double half = 0.5 * turn * M_PI / 180.0;
        const Vec3 d1(-std::cos(half), 0, -std::sin(half)), d2(std::cos(half), 0, -std::sin(half));
        const Vec3 n1(-std::sin(half), 0, std::cos(half)), n2(std::sin(half), 0, std::cos(half));
        for (const double orientation : {1.0, -1.0}) {  // orientation of the cloth's faces
            const auto frame = find_edge_frame(wire, 0, Vec3(0, 0.2, 1e-3),
                                               {orientation * (n1 + n2), d1 + d2, Vec3(0, 0, 1)});
            ASSERT_TRUE(frame);
            EXPECT_NEAR((frame->outward - Vec3::UnitZ()).norm(), 0.0, kRoundOff) << turn;
        }
    }
    EXPECT_FALSE(find_edge_frame(wire, 0, Vec3(0, 0.2, 1e-3), kNoCloth));
}

TEST(FeatureFrame, OfABoxCornerIsTheDiagonal)
{
    const Obstacle box = samples::make_obstacle(samples::box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
    const int corner = find_corner(box, Vec3(1, 0, 1));
    ASSERT_GE(corner, 0);
    const auto frame = find_corner_frame(box, corner, Vec3(1, 0, 1), kNoCloth);
    ASSERT_TRUE(frame);
    EXPECT_NEAR((frame->outward - Vec3(1, -1, 1).normalized()).norm(), 0.0, kRoundOff);
    EXPECT_NEAR(frame->mitre, std::sqrt(3.0), kRoundOff);
}

TEST(FeatureFrame, OfAConesApexIsItsAxis)
{
    const Obstacle cone = samples::make_obstacle(samples::cone(32, 0.5));
    const int corner = find_corner(cone, Vec3(0, 0, 1));
    ASSERT_GE(corner, 0);
    const auto frame = find_corner_frame(cone, corner, Vec3(0, 0, 1.01), kNoCloth);
    ASSERT_TRUE(frame);
    EXPECT_NEAR((frame->outward - Vec3::UnitZ()).norm(), 0.0, 1e-6);
    EXPECT_NEAR(frame->mitre, 2.0, kRoundOff);
}

TEST(FeatureFrame, OfANailFollowsTheCloth)
{
    const Obstacle nail = samples::make_obstacle(samples::nails({{0, 0, 0}}));
    const auto flat =
        find_corner_frame(nail, 0, Vec3(0, 0, 1e-3), {Vec3(0, 0, -4), Vec3::Zero(), Vec3::Zero()});
    ASSERT_TRUE(flat);
    EXPECT_NEAR((flat->outward - Vec3::UnitZ()).norm(), 0.0, kRoundOff);
    const auto tent =
        find_corner_frame(nail, 0, Vec3(0, 0, 1e-3), {Vec3(0, 0, 0.4), Vec3(0, 0, -3.9), Vec3::Zero()});
    ASSERT_TRUE(tent);
    EXPECT_NEAR((tent->outward - Vec3::UnitZ()).norm(), 0.0, kRoundOff);
}

TEST(FindMiddle, HasTheGreatestLeastPartAmongAFineGridOfDirections)
{
    unsigned seed = 7;
    const auto next = [&] {
        return 2.0 * ((seed = seed * 1664525u + 1013904223u) >> 8) / double(1 << 24) - 1.0;
    };
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Vec3> directions;
        for (int k = 0; k < 2 + trial % 5; ++k)
            directions.push_back(Vec3(next(), next(), 0.3 + std::abs(next())).normalized());
        const auto least = [&](const Vec3& n) {
            double part = 1.0;
            for (const Vec3& d : directions) part = std::min(part, d.dot(n));
            return part;
        };
        double best = -1.0;
        for (int i = 0; i <= 60; ++i)
            for (int j = 0; j < 120; ++j) {
                const double theta = M_PI * i / 60.0, phi = 2.0 * M_PI * j / 120.0;
                best = std::max(best, least({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                             std::cos(theta)}));
            }
        const auto middle = find_middle(directions);
        ASSERT_TRUE(middle);
        EXPECT_GE(least(*middle), best - kRoundOff);
    }
    EXPECT_FALSE(find_middle({Vec3::UnitZ(), -Vec3::UnitZ()}));
    EXPECT_FALSE(find_middle({}));
}

}  // namespace
}  // namespace arris
