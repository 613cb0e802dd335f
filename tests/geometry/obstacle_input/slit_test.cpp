// SPDX-License-Identifier: GPL-3.0-or-later
// Room between parts of a body that come together: its width by the distance of the parts afterwards, and
// what must stay as it is.
#include "geometry/obstacle_input/deform/slit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "geometry/obstacle_input/deform/slit_samples.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/elbow_body.h"
#include "tests/pose_samples.h"

namespace arris {
namespace {

constexpr double kWidth = 0.005, kInterval = 0.04;  // m, s

/// Height of the upper leg's lowest point over the lower leg's highest one, away from the bend; both legs are
/// straight.
double distance_of_legs(const ElbowBody& body, const std::vector<Vec3>& rest, const std::vector<Vec3>& points)
{
    double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
    for (std::size_t p = 0; p < rest.size(); ++p) {
        const double x = rest[p].x();
        if (x < -0.03 && x > 0.03 - body.leg) highest = std::max(highest, points[p].z());
        if (x > body.bend_length() + 0.03 && x < body.bend_length() + body.leg - 0.03)
            lowest = std::min(lowest, points[p].z());
    }
    return lowest - highest;
}

double greatest(const std::vector<double>& values)
{
    return *std::max_element(values.begin(), values.end());
}

TEST(Slit, LegsOfAnElbowComeApartByItsWidth)
{
    for (const double gap : {0.02, 0.006, 0.002, 0.0, -0.004, -0.02}) {
        ElbowBody body;
        body.thick = 0.09;  // more than the retreat spreads to
        body.gap = gap;
        const ObstacleMesh mesh = body.make();
        const SlitFinder finder(mesh, kWidth);
        const std::vector<Vec3> bent = body.bend(mesh.points, M_PI);
        ASSERT_NEAR(distance_of_legs(body, mesh.points, bent), gap, 1e-12);
        const std::vector<double> retreat = finder.find_retreat(bent);
        const double left = distance_of_legs(body, mesh.points, finder.apply(bent, retreat));
        EXPECT_GE(left, (gap > -kWidth ? 0.9 : 0.8) * kWidth) << gap;
        EXPECT_LE(left, std::max(gap, 1.7 * kWidth) + 1e-12) << gap;
        // The back of the legs stays, but at their ends.
        for (std::size_t p = 0; p < bent.size(); ++p) {
            if (gap > -0.01 && mesh.points[p].z() < -0.4 * body.thick &&
                mesh.points[p].x() > 0.08 - body.leg &&
                mesh.points[p].x() < body.bend_length() + body.leg - 0.08) {
                EXPECT_EQ(retreat[p], 0.0) << gap;
            }
        }
        if (gap > kWidth) {
            EXPECT_EQ(greatest(retreat), 0.0) << gap;
        }
    }
}

/// Bent by 192 degrees, the legs are deep inside each other: no way out is tried at the cost of the legs.
TEST(Slit, RetreatsByNoMoreThanPartsOverlap)
{
    ElbowBody body;
    body.gap = -0.012;
    const ObstacleMesh mesh = body.make();
    const double overlap = 0.012 + 2.0 * body.leg * std::sin(12.0 * M_PI / 180.0);
    for (const double degrees : {183.0, 192.0}) {
        const SlitFinder finder(mesh, kWidth);
        const double most = greatest(finder.find_retreat(body.bend(mesh.points, degrees * M_PI / 180.0)));
        EXPECT_GT(most, 0.5 * (0.012 + kWidth)) << degrees;
        EXPECT_LT(most, 0.5 * (std::min(body.thick, overlap) + kWidth) + kWidth) << degrees;
    }
}

TEST(Slit, AStraightOrOpenElbowStays)
{
    const ElbowBody body;
    const ObstacleMesh mesh = body.make();
    const SlitFinder finder(mesh, kWidth);
    for (const double angle : {0.0, 1.0, 2.5})
        EXPECT_EQ(greatest(finder.find_retreat(body.bend(mesh.points, angle))), 0.0) << angle;
}

/// A body without thickness between its sides: its back is near along no way, and looks away.
TEST(Slit, ThinLimbsStay)
{
    ElbowBody body;
    body.thick = 0.004;
    body.cell = 0.002;
    body.gap = 0.05;
    const ObstacleMesh mesh = body.make();
    EXPECT_EQ(greatest(SlitFinder(mesh, kWidth).find_retreat(body.bend(mesh.points, M_PI))), 0.0);
}

ObstacleMesh two_boxes(const Vec3& second)
{
    ObstacleMesh mesh = make_box({0.1, 0.1, 0.1});
    ObstacleMesh other = make_box({0.1, 0.1, 0.1});
    const int first = static_cast<int>(mesh.points.size());
    for (const Vec3& p : other.points) mesh.points.push_back(p + second);
    for (Face face : other.faces) {
        for (int& p : face) p += first;
        mesh.faces.push_back(face);
    }
    return mesh;
}

/// Boots over legs, buttons on a shirt: what crosses or is near in the mesh's own pose belongs together.
TEST(Slit, WhatBelongsTogetherStays)
{
    for (const Vec3& second : {Vec3(0.05, 0.03, 0.02), Vec3(0.0, 0.0, 0.102), Vec3(0.0, 0.0, 0.1)}) {
        const ObstacleMesh mesh = two_boxes(second);
        EXPECT_EQ(greatest(SlitFinder(mesh, kWidth).find_retreat(mesh.points)), 0.0) << second.transpose();
    }
}

TEST(Slit, SeparatePiecesComeApart)
{
    const ObstacleMesh mesh = two_boxes(Vec3(0.01, 0.02, 0.2));
    std::vector<Vec3> points = mesh.points;
    for (std::size_t p = points.size() / 2; p < points.size(); ++p) points[p] -= Vec3(0.0, 0.0, 0.101);
    const SlitFinder finder(mesh, kWidth);
    EXPECT_FALSE(find_crossing_faces(mesh, points).empty());
    EXPECT_TRUE(find_crossing_faces(mesh, finder.apply(points, finder.find_retreat(points))).empty());
}

TEST(Slit, TheSkinRetreatsBeforeAndReturnsAfter)
{
    ElbowBody body;
    body.gap = -0.004;
    body.cell = 0.015;
    const ObstacleMesh mesh = body.make();
    std::vector<std::vector<Vec3>> samples;
    constexpr int kClosed = 6, kCount = 14;
    for (int k = 0; k < kCount; ++k) samples.push_back(body.bend(mesh.points, k == kClosed ? M_PI : 2.0));
    std::vector<std::vector<Vec3>> made;
    const SlitSurvey survey = make_slit(PoseSamples(samples, kInterval), mesh, kWidth,
                                        [&](const std::vector<Vec3>& points) { made.push_back(points); });
    ASSERT_EQ(made.size(), samples.size());
    EXPECT_EQ(survey.samples, 9U);
    EXPECT_EQ(survey.greatest_at, static_cast<std::size_t>(kClosed));
    EXPECT_GE(distance_of_legs(body, mesh.points, made[kClosed]), 0.9 * kWidth);
    double last = 0.0;
    for (int k = 0; k < kCount; ++k) {
        double most = 0.0;
        for (std::size_t p = 0; p < mesh.points.size(); ++p)
            most = std::max(most, (made[k][p] - samples[k][p]).norm());
        EXPECT_EQ(most == 0.0, std::abs(k - kClosed) > 4) << k;
        EXPECT_LE(std::abs(most - last), 0.21 * survey.greatest_retreat) << k;
        last = most;
    }
    // A single sample is its own neighbourhood.
    EXPECT_EQ(
        make_slit(PoseSamples({samples[kClosed]}, kInterval), mesh, kWidth, [](const std::vector<Vec3>&) {})
            .samples,
        1U);
}

}  // namespace
}  // namespace arris
