// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/rigid_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <numbers>

#include "geometry/input_error.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kRounding = 1e-14;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

double orthogonality_error(const Mat3& R)
{
    return (R.transpose() * R - Mat3::Identity()).norm() + std::abs(R.determinant() - 1.0);
}

TEST(RotationAbout, IsExactAtQuarterTurns)
{
    Mat3 quarter;
    quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    EXPECT_EQ(rotation_about(Vec3(0, 0, 7), 90.0), quarter);
    EXPECT_EQ(rotation_about(Vec3(0, 0, 1e-300), 450.0), quarter);
    EXPECT_EQ(rotation_about(Vec3(0, 0, 1e300), -90.0), quarter.transpose());
    EXPECT_EQ(rotation_about(Vec3::UnitX(), 180.0), Vec3(1, -1, -1).asDiagonal().toDenseMatrix());
    EXPECT_EQ(rotation_about(Vec3(1, 2, 3), 360.0), Mat3::Identity());
}

TEST(RotationAbout, IsARightHandedRotationByItsAngle)
{
    for (double degrees = -725.0; degrees < 725.0; degrees += 13.7) {
        const Vec3 axis(1.0, -2.0, 0.5);
        const Mat3 R = rotation_about(axis, degrees);
        EXPECT_LT(orthogonality_error(R), kRounding);
        EXPECT_LT((R * axis - axis).norm(), 1e-14);
        const Eigen::AngleAxisd reference(degrees * kPi / 180.0, axis.normalized());
        EXPECT_LT((R - reference.toRotationMatrix()).norm(), 1e-13) << degrees;
    }
}

TEST(RotationAbout, RefusesWhatHasNoAxis)
{
    EXPECT_THROW(rotation_about(Vec3::Zero(), 10.0), InputError);
    EXPECT_THROW(rotation_about(Vec3::UnitX(), std::nan("")), InputError);
    EXPECT_THROW(rotation_about(Vec3(kInfinity, 0, 0), 1.0), InputError);
}

TEST(RigidMotion, AtRestIsTheIdentityForever)
{
    const RigidMotion rest;
    EXPECT_FALSE(rest.is_moving());
    EXPECT_THAT(rest.jumps(), IsEmpty());
    for (const double t : {-1.0, 0.0, 1e9}) EXPECT_EQ(rest.at(t)(Vec3(1, 2, 3)), Vec3(1, 2, 3));
}

TEST(RigidMotion, TurnsAboutItsPivotWhileItMoves)
{
    RigidMotion motion;
    motion.velocity = Vec3(1, 0, 2);
    motion.angular_velocity = Vec3(0, 0, kPi);
    motion.pivot = Vec3(1, 1, 0);
    motion.start = 0.5;
    motion.stop = 1.0;
    // Half a second at pi rad/s: a quarter turn about (1, 1) moves (2, 1) to (1, 2), plus the motion by the
    // velocity.
    EXPECT_LT((motion.at(1.0)(Vec3(2, 1, 0)) - Vec3(1.5, 2, 1)).norm(), kRounding);
    EXPECT_EQ(motion.at(0.5)(Vec3(2, 1, 0)), Vec3(2, 1, 0));
    EXPECT_EQ(motion.at(-3.0)(Vec3(2, 1, 0)), Vec3(2, 1, 0));
    EXPECT_EQ(motion.at(7.0)(Vec3(2, 1, 0)), motion.at(1.0)(Vec3(2, 1, 0)));
    EXPECT_THAT(motion.jumps(), ElementsAre(0.5, 1.0));
}

TEST(RigidMotion, HasThePrescribedVelocityEverywhere)
{
    RigidMotion motion;
    motion.velocity = Vec3(0.3, -1, 2);
    motion.angular_velocity = Vec3(1, 2, -5);
    motion.pivot = Vec3(5, -3, 1);
    const Vec3 p(0.2, 0.7, -1.1);
    const double h = 1e-5;
    for (const double t : {0.1, 1.0, 10.0}) {
        const Vec3 difference = (motion.at(t + h)(p) - motion.at(t - h)(p)) / (2.0 * h);
        const Vec3 pivot_now = motion.pivot + motion.velocity * t;
        const Vec3 exact = motion.velocity + motion.angular_velocity.cross(motion.at(t)(p) - pivot_now);
        EXPECT_LT((difference - exact).norm(), 1e-6 * exact.norm());  // central difference, |w|^3 h^2
        EXPECT_LT(orthogonality_error(motion.at(t).rotation), kRounding);
    }
}

TEST(RigidMotion, InverseUndoesThePlacement)
{
    RigidMotion motion;
    motion.angular_velocity = Vec3(1e-9, 3, -2);
    motion.velocity = Vec3(1, 1, 1);
    const Placement placement = motion.at(0.7);
    EXPECT_LT((placement.inverse(placement(Vec3(4, 5, 6))) - Vec3(4, 5, 6)).norm(), 1e-13);
}

TEST(RigidMotion, TinyRotationsKeepTheirFirstOrder)
{
    RigidMotion motion;
    motion.angular_velocity = Vec3(0, 0, 1e-200);
    EXPECT_TRUE(motion.is_moving());
    EXPECT_DOUBLE_EQ(motion.at(1.0).rotation(1, 0), 1e-200);
}

TEST(RigidMotion, ThatNeverStartsToRunDoesNotMove)
{
    RigidMotion motion;
    motion.velocity = Vec3::UnitX();
    motion.start = motion.stop = 1.0;
    EXPECT_FALSE(motion.is_moving());
    EXPECT_THAT(motion.jumps(), IsEmpty());
    EXPECT_EQ(motion.at(5.0)(Vec3::Zero()), Vec3::Zero());
}

TEST(RigidMotion, JumpsAreFiniteAndAfterTheBeginning)
{
    RigidMotion motion;
    motion.velocity = Vec3::UnitX();
    EXPECT_THAT(motion.jumps(), IsEmpty());
    motion.start = 2.0;
    EXPECT_THAT(motion.jumps(), ElementsAre(2.0));
    motion.start = -1.0;
    motion.stop = 3.0;
    EXPECT_THAT(motion.jumps(), ElementsAre(3.0));
}

Keyframe key(double time, const Vec3& translate, double degrees, const Vec3& axis = Vec3::UnitZ())
{
    return {time, translate, Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kPi / 180.0, axis))};
}

TEST(Keyframes, InterpolateAndStayOutside)
{
    RigidMotion motion;
    motion.keyframes = {key(1, {0, 0, 0}, 0), key(3, {2, 4, 6}, 90)};
    EXPECT_TRUE(motion.is_moving());
    EXPECT_LT((motion.at(0.0)(Vec3(1, 0, 0)) - Vec3(1, 0, 0)).norm(), kRounding);
    EXPECT_LT((motion.at(9.0)(Vec3(1, 0, 0)) - Vec3(2, 5, 6)).norm(), kRounding);
    const double half = std::sqrt(0.5);
    EXPECT_LT((motion.at(2.0)(Vec3(1, 0, 0)) - Vec3(1 + half, 2 + half, 3)).norm(), kRounding);
    EXPECT_THAT(motion.jumps(), ElementsAre(1.0, 3.0));
}

TEST(Keyframes, TakeTheShorterArc)
{
    RigidMotion motion;
    motion.keyframes = {key(0, Vec3::Zero(), 0), key(1, Vec3::Zero(), 350)};
    const Eigen::AngleAxisd halfway(-5.0 * kPi / 180.0, Vec3::UnitZ());
    EXPECT_LT((motion.at(0.5).rotation - halfway.toRotationMatrix()).norm(), 1e-13);
    motion.keyframes[1].rotate.coeffs() *= -3.0;  // a scaled quaternion of this rotation
    EXPECT_LT((motion.at(0.5).rotation - halfway.toRotationMatrix()).norm(), 1e-13);
}

TEST(Keyframes, TurnAtAConstantRate)
{
    RigidMotion motion;
    motion.keyframes = {key(0, Vec3::Zero(), 10, Vec3(1, 2, 2) / 3),
                        key(2, Vec3::Zero(), 170, Vec3(1, 2, 2) / 3)};
    for (double t = 0.0; t <= 2.0; t += 0.125) {
        const Eigen::AngleAxisd exact((10.0 + 80.0 * t) * kPi / 180.0, Vec3(1, 2, 2) / 3);
        EXPECT_LT((motion.at(t).rotation - exact.toRotationMatrix()).norm(), 1e-13) << t;
    }
}

TEST(Keyframes, OfOnePoseDoNotMove)
{
    RigidMotion motion;
    motion.keyframes = {key(0, {1, 2, 3}, 30)};
    EXPECT_FALSE(motion.is_moving());
    motion.keyframes.push_back(key(1, {1, 2, 3}, 30));
    motion.keyframes[1].rotate.coeffs() *= -1.0;
    EXPECT_FALSE(motion.is_moving());
    EXPECT_THAT(motion.jumps(), IsEmpty());
    EXPECT_LT((motion.at(0.5)(Vec3::Zero()) - Vec3(1, 2, 3)).norm(), kRounding);
}

}  // namespace
}  // namespace arris
