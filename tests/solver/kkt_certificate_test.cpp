// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/kkt_certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A = 2 I, b = (2, -4, 6), u = (1, 0, 3), the second resting on 0 with lambda = 4.
struct Certified {
    testing::OwnedProblem owned{testing::lower_blocks(2.0 * Eigen::Matrix3d::Identity()),
                                Eigen::Vector3d(2, -4, 6)};
    Eigen::VectorXd velocity = Eigen::Vector3d(1, 0, 3), multipliers = Eigen::Vector3d(0, 4, 0);

    Certified() { owned.problem.lower[1] = 0.0; }
    double residual() const { return kkt_residual(owned.problem, velocity, multipliers); }
};

TEST(KktCertificate, IsZeroAtTheSolution)
{
    EXPECT_EQ(Certified().residual(), 0.0);
}

TEST(KktCertificate, IsStationarityRelativeToItsOwnTerms)
{
    Certified c;
    c.velocity[0] = 1.5;  // |3 - 2| / (3 + 2)
    EXPECT_DOUBLE_EQ(c.residual(), 0.2);
}

TEST(KktCertificate, IsViolationRelativeToTheGreatestSpeed)
{
    Certified c;
    c.owned.problem.lower[0] = 1.75;
    EXPECT_DOUBLE_EQ(c.residual(), 0.25);
}

TEST(KktCertificate, IsAWrongSignRelativeToTheGreatestMultiplier)
{
    Certified c;
    c.owned.problem.lower[0] = 1.0;
    c.multipliers[0] = -1.0;
    c.owned.rhs[0] = 3.0;
    EXPECT_DOUBLE_EQ(c.residual(), 0.25);
}

TEST(KktCertificate, IsComplementarityRelativeToBoth)
{
    Certified c;
    c.owned.problem.lower[0] = -2.0;  // gap 3 of 3, multiplier 1 of 4
    c.multipliers[0] = 1.0;
    c.owned.rhs[0] = 1.0;
    EXPECT_DOUBLE_EQ(c.residual(), 0.25);
}

TEST(KktCertificate, IsInfiniteForAForceFromNoBound)
{
    Certified c;
    c.multipliers[0] = 1.0;
    c.owned.rhs[0] = 1.0;
    EXPECT_TRUE(std::isinf(c.residual()));
}

TEST(KktCertificate, AsksOfTheFixedOnlyThatTheyRest)
{
    Certified c;
    c.owned.problem.is_fixed[2] = 1;
    EXPECT_DOUBLE_EQ(c.residual(), 1.0);
    c.velocity[2] = 0.0;
    EXPECT_EQ(c.residual(), 0.0);
}

TEST(KktCertificate, LetsNoNaNPass)
{
    for (int i = 0; i < 3; ++i) {
        Certified velocity, multiplier, rhs, matrix, lower;
        velocity.velocity[i] = kNaN;
        EXPECT_TRUE(std::isnan(velocity.residual()));
        multiplier.multipliers[i] = kNaN;
        EXPECT_TRUE(std::isnan(multiplier.residual()));
        rhs.owned.rhs[i] = kNaN;
        EXPECT_TRUE(std::isnan(rhs.residual()));
        matrix.owned.matrix.coeffRef(i, i) = kNaN;
        EXPECT_TRUE(std::isnan(matrix.residual()));
        lower.owned.problem.lower[i] = kNaN;
        EXPECT_TRUE(std::isnan(lower.residual()));
    }
}

TEST(KktCertificate, DoesNotOverflowOrVanishInExtremeUnits)
{
    for (const double unit : {1e-160, 1e160}) {
        Certified c;
        c.velocity *= unit;
        c.multipliers *= unit;
        c.owned.rhs *= unit;
        EXPECT_EQ(c.residual(), 0.0);
        c.owned.problem.lower[0] = -2.0 * unit;
        c.multipliers[0] = unit;
        c.owned.rhs[0] = unit;
        EXPECT_DOUBLE_EQ(c.residual(), 0.25);
    }
}

}  // namespace
}  // namespace arris
