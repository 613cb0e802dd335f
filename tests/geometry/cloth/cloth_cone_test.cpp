// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/cloth_cone.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "geometry/middle_direction.h"
#include "geometry/obstacle/feature_frame.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;

Vec3 direction(double polar, double azimuth)
{
    return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), -std::cos(polar)};
}

/// A cone around -z with ridges at these angles from -z, evenly spaced in azimuth.
std::vector<FaceSector> make_cone(const std::vector<double>& polar)
{
    const std::size_t n = polar.size();
    std::vector<FaceSector> sectors;
    for (std::size_t k = 0; k < n; ++k)
        sectors.push_back({direction(polar[k], 2.0 * M_PI * double(k) / double(n)),
                           direction(polar[(k + 1) % n], 2.0 * M_PI * double(k + 1) / double(n))});
    return sectors;
}

double room_of(const std::vector<FaceSector>& sectors, const Vec3& at)
{
    double room = 1.0;
    for (const FaceSector& sector : sectors) room = std::min(room, sine_to_sector(sector, at));
    return room;
}

/// A randomly pleated cone with ridges between 10 and 100 degrees from -z.
std::vector<FaceSector> random_cone(std::mt19937& random)
{
    std::uniform_real_distribution<double> polar(0.17, 1.75);
    std::vector<double> ridges(std::uniform_int_distribution<int>(3, 10)(random));
    for (double& ridge : ridges) ridge = polar(random);
    return make_cone(ridges);
}

/// Brute force by sample directions in the face.
double sampled_sine(const FaceSector& sector, const Vec3& at)
{
    double nearest = 1.0;
    for (int i = 0; i <= 2000; ++i) {
        const Vec3 on = ((2000 - i) * sector[0] + i * sector[1]).normalized();
        if (on.dot(at) > 0.0) nearest = std::min(nearest, on.cross(at).norm());
    }
    return nearest;
}

TEST(SineToSector, IsThatToTheNearestDirectionInIt)
{
    constexpr double kStep = 2e-3;  // rad, between samples
    std::mt19937 random(3);
    std::normal_distribution<double> any;
    const auto unit = [&] { return Vec3(any(random), any(random), any(random)).normalized(); };
    for (int trial = 0; trial < 300; ++trial) {
        const FaceSector sector = {unit(), unit()};
        const Vec3 at = unit();
        EXPECT_NEAR(sine_to_sector(sector, at), sampled_sine(sector, at), kStep) << trial;
        EXPECT_NEAR(sine_to_sector(sector, sector[1]), 0.0, kRoundOff);
    }
    EXPECT_NEAR(sine_to_sector({Vec3::UnitX(), Vec3::UnitX()}, Vec3::UnitY()), 1.0, kRoundOff) << "collapsed";
    EXPECT_EQ(sine_to_sector({Vec3::UnitX(), Vec3::UnitY()}, -Vec3::UnitX()), 1.0) << "the vertex is nearest";
}

TEST(ConeAxis, OfFlatClothIsItsNormalHoweverObliqueItIsSeen)
{
    constexpr double kAlmost = 0.05;  // rad: the axis is not turned for the last 0.1 % of room
    const std::vector<FaceSector> flat = make_cone(std::vector<double>(6, M_PI / 2.0));
    for (const double polar : {0.0, 0.3, 0.8, 1.4, 1.55})
        EXPECT_LT((find_cone_axis(flat, direction(polar, 0.4)) + Vec3::UnitZ()).norm(), kAlmost) << polar;
}

/// Normals of the faces towards -z, in the order around the cone.
std::vector<Vec3> find_inward(const std::vector<FaceSector>& cone)
{
    std::vector<Vec3> inward;
    for (const FaceSector& sector : cone) inward.push_back(sector[1].cross(sector[0]).normalized());
    return inward;
}

TEST(ConeAxis, WithoutPleatsIsTheMiddleOfTheNormals)
{
    constexpr double kAlmost = 0.03;  // rad
    const std::vector<FaceSector> cone = make_cone({0.7, 0.9, 0.8, 1.0, 0.9});
    const std::optional<Vec3> middle = find_middle(find_inward(cone));
    ASSERT_TRUE(middle);
    EXPECT_LT((find_cone_axis(cone, direction(0.4, 2.0)) - *middle).norm(), kAlmost);
}

TEST(ConeAxis, OfAPleatedConeHasRoomWhereItsNormalsHaveNoMiddle)
{
    // Four pleats, each partly over the next.
    std::vector<FaceSector> cone;
    for (int k = 0; k < 4; ++k) {
        const double at = 0.5 * M_PI * k;
        const Vec3 outer = direction(1.2, at + 1.8);
        cone.push_back({direction(0.3, at), outer});
        cone.push_back({outer, direction(0.3, at + 0.5 * M_PI)});
    }
    EXPECT_FALSE(find_middle(find_inward(cone)));
    const Vec3 inside = direction(0.15, 0.3);
    EXPECT_GT(room_of(cone, find_cone_axis(cone, inside)), 1.5 * room_of(cone, inside));
    EXPECT_LT((find_cone_axis(cone, inside) + Vec3::UnitZ()).norm(), 0.01);
}

TEST(ConeAxis, NeverHasLessRoomAndNoFaceIsOnTheWay)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> angle(0.0, 2.0 * M_PI), polar(0.0, 0.16);
    int turned = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const std::vector<FaceSector> cone = random_cone(random);
        const Vec3 inside = direction(polar(random), angle(random));
        const Vec3 axis = find_cone_axis(cone, inside);
        const double room = room_of(cone, inside);
        EXPECT_GE(room_of(cone, axis), room);
        turned += room_of(cone, axis) > 1.1 * room ? 1 : 0;
        const auto turn = Eigen::Quaterniond::FromTwoVectors(inside, axis);
        for (int i = 0; i <= 50; ++i)
            EXPECT_GT(room_of(cone, Eigen::Quaterniond::Identity().slerp(i / 50.0, turn) * inside),
                      0.5 * room)
                << trial << " at " << i;
    }
    EXPECT_GT(turned, 250);
}

TEST(ConeAxis, HasTheMostRoomOfWhatIsAroundIt)
{
    // Share of the room that may be missing, as turns end where the gain is small.
    constexpr double kShare = 0.02;
    std::mt19937 random(5);
    int worse = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<FaceSector> cone = random_cone(random);
        const Vec3 axis = find_cone_axis(cone, -Vec3::UnitZ());
        const Vec3 side = axis.unitOrthogonal();
        for (int k = 0; k < 24; ++k) {
            const Vec3 about = Eigen::AngleAxisd(2.0 * M_PI * k / 24.0, axis) * side;
            const Vec3 beside = Eigen::AngleAxisd(0.02, about) * axis;
            worse += room_of(cone, beside) > (1.0 + kShare) * room_of(cone, axis) ? 1 : 0;
        }
    }
    EXPECT_EQ(worse, 0);
}

TEST(ConeAxis, StaysWhereItTouchesAFaceOrThereIsNone)
{
    const std::vector<FaceSector> cone = make_cone({0.5, 0.5, 0.5});
    EXPECT_EQ(find_cone_axis(cone, cone[1][0]), cone[1][0]);
    EXPECT_EQ(find_cone_axis({}, Vec3::UnitX()), Vec3::UnitX());
    const Vec3 axis = find_cone_axis({{Vec3::UnitX(), Vec3::UnitX()}, {Vec3::UnitX(), -Vec3::UnitX()}},
                                     Vec3(0.1, 0.3, -1.0).normalized());
    EXPECT_TRUE(axis.allFinite()) << "sectors without a plane";
}

}  // namespace
}  // namespace arris
