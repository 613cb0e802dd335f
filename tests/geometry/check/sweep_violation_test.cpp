// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/sweep_violation.h"

#include <gtest/gtest.h>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/contact/contact_plane.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;

/// One cloth triangle over a large sheet in z = 0; its vertex 0 moves. The sheet's two faces have one plane,
/// so either may be above the origin.
struct Meeting {
    Obstacle obstacle{samples::moved(samples::sheet(1, 1, [](int, int) { return 0.0; }),
                                     [](const Vec3& p) { return Vec3(20.0 * p - Vec3(10, 10, 0)); }),
                      30.0};
    std::vector<Face> faces{{0, 1, 2}};
    MeshTopology topology = make_topology(3, faces);
    ClothMotion motion{&faces, &topology.edges, {}, {}};

    Meeting(const Vec3& begin, const Vec3& end)
    {
        motion.begin = {begin, Vec3(1, 0, 5), Vec3(0, 1, 5)};
        motion.end = {end, Vec3(1, 0, 5), Vec3(0, 1, 5)};
    }
    Meeting(const Meeting&) = delete;

    std::optional<ObstacleContact> contact(const Vec3& hit_normal) const
    {
        const SweepHit hit{0.5, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, Vec3::Zero(), hit_normal};
        return make_vertex_violation(obstacle, motion, 0, 0, hit, motion.begin[0], kThickness);
    }
    Vec3 normal(const Vec3& hit_normal) const
    {
        const std::optional<ObstacleContact> found = contact(hit_normal);
        return found ? found->normal : Vec3::Zero();
    }
};

TEST(SweepViolation, AVertexGetsThePlaneOfTheFaceOnItsSide)
{
    const Meeting above(Vec3(0, 0, 1), Vec3(0, 0, -1));
    EXPECT_EQ(above.normal(Vec3::UnitX()), Vec3::UnitZ());
    const Meeting below(Vec3(0, 0, -1), Vec3(0, 0, 1));
    EXPECT_EQ(below.normal(Vec3::UnitX()), -Vec3::UnitZ());
    const Meeting oblique(Vec3(0.3, 0, -1), Vec3(-0.3, 0, 1));
    EXPECT_EQ(oblique.normal(Vec3::UnitX()), -Vec3::UnitZ());
}

TEST(SweepViolation, TheStandOffIsNoMoreThanTheGapAtBegin)
{
    EXPECT_EQ(Meeting(Vec3(0, 0, 1), Vec3(0, 0, -1)).contact(Vec3::UnitZ())->least_gap, kThickness);
    EXPECT_EQ(Meeting(Vec3(0, 0, 1e-6), Vec3(0, 0, -1)).contact(Vec3::UnitZ())->least_gap, 1e-6);
}

// The rounding of a step's positions closes smaller gaps, so a row that kept one would be violated again.
TEST(SweepViolation, AGapBelowTheTouchDistanceHasToGrowToIt)
{
    const Meeting meeting(Vec3(0, 0, 1e-15), Vec3(0, 0, -1));
    EXPECT_EQ(meeting.contact(Vec3::UnitZ())->least_gap, touch_distance(meeting.obstacle, kThickness));
}

// At a face's rim, for a motion from the side, the face's plane neither gives a side nor restrains the
// vertex.
TEST(SweepViolation, AVertexThatComesAlongTheFaceGetsThePlaneOfTheTouch)
{
    const Meeting meeting(Vec3(1, 0, 1e-6), Vec3(-1, 0, -1));
    EXPECT_EQ(meeting.normal(Vec3::UnitX()), Vec3::UnitX());
}

TEST(SweepViolation, APlaneThatTheEndKeepsIsNone)
{
    const Meeting meeting(Vec3(1, 0, 1), Vec3(-1, 0, 0.5));
    EXPECT_EQ(meeting.normal(Vec3::UnitX()), Vec3::UnitX());
}

TEST(SweepViolation, WhereNoPlaneServesItIsAcrossTheWay)
{
    const Meeting meeting(Vec3(1, 0, 0), Vec3(-1, 0, 0));
    EXPECT_EQ(meeting.normal(Vec3::Zero()), Vec3::UnitX());
    EXPECT_EQ(meeting.normal(-Vec3::UnitX()), Vec3::UnitX());  // the vertex began behind this plane
    EXPECT_EQ(meeting.normal(Vec3::UnitY()), Vec3::UnitX());   // the vertex moves along this plane
}

TEST(SweepViolation, WhatDoesNotMoveGetsNone)
{
    const Meeting meeting(Vec3::Zero(), Vec3::Zero());
    EXPECT_FALSE(meeting.contact(Vec3::UnitZ()));
    EXPECT_FALSE(meeting.contact(Vec3::Zero()));
}

}  // namespace
}  // namespace arris
