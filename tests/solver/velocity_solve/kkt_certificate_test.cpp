// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/kkt_certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A = 2 I, b = (2, -4, 6), u = (1, 0, 3); the second coordinate is on its bound 0 with lambda = 4.
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
    c.owned.problem.lower[0] = -2.0;  // relative gap 3 / 3, relative multiplier 1 / 4
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

/// A = 2 I, b = (2, -4, 6); the row is 2 u_1 + 4 u_2 >= 12, so u = (1, 0, 3) + C^T lambda / 2.
struct WithRow {
    testing::OwnedProblem owned{testing::lower_blocks(2.0 * Eigen::Matrix3d::Identity()),
                                Eigen::Vector3d(2, -4, 6)};
    ConstraintRows constraints;
    Eigen::VectorXd velocity = Eigen::Vector3d(1, 0, 3), multipliers = Eigen::Vector3d::Zero(),
                    row_multipliers = Eigen::VectorXd::Zero(1);

    WithRow()
    {
        ConstraintRow row;
        row.count = 2;
        row.coordinate[0] = 1;
        row.coordinate[1] = 2;
        row.coefficient[0] = 2.0;
        row.coefficient[1] = 4.0;
        row.lower = 12.0;
        owned.problem.rows = {row};
        // The row scaled to (1/2, 1) has the bound 3: at u = (1, -2, 3) the gap is -1, which lambda = 8/5
        // closes.
        velocity = Eigen::Vector3d(1, -1.6, 3.8);
        row_multipliers[0] = 1.6;
        set_bound(12.0);
    }
    void set_bound(double lower)
    {
        owned.problem.rows[0].lower = lower;
        constraints = scale_rows(owned.problem, 1.0);
        constraints.rows[0].compliance = 0.0;  // rigid, but where a test says otherwise
    }
    double residual() const
    {
        return kkt_residual(owned.problem, constraints, velocity, multipliers, row_multipliers);
    }
};

TEST(KktCertificate, TakesInRows)
{
    EXPECT_LE(WithRow().residual(), 1e-15);
    WithRow stationarity, violation, sign, complementarity;
    stationarity.row_multipliers[0] = 1.0;
    EXPECT_NEAR(stationarity.residual(), 0.6 / 14.6, 1e-6);  // tolerance 1e-6: the least speed in the scale
    violation.velocity = Eigen::Vector3d(1, -2, 3);
    violation.row_multipliers[0] = 0.0;
    EXPECT_DOUBLE_EQ(violation.residual(), 1.0 / 3.0);
    sign.set_bound(-1e3);
    sign.velocity = Eigen::Vector3d(1, -2.25, 2.5);
    sign.row_multipliers[0] = -1.0;
    EXPECT_GE(sign.residual(), 1.0);
    // The relative gap is 1 / 3.8; the row's multiplier is the largest.
    complementarity.set_bound(8.0);
    EXPECT_NEAR(complementarity.residual(), 1.0 / 3.8, 1e-12);
}

TEST(KktCertificate, LetsARowGiveWayAsItsSpringDoes)
{
    WithRow row;
    row.set_bound(16.0);  // 4 for the scaled row, whose gap is -1 at lambda = 8/5
    EXPECT_NEAR(row.residual(), 1.0 / 3.8, 1e-12);
    row.constraints.rows[0].compliance = 1.0 / 1.6;
    EXPECT_LE(row.residual(), 1e-15);
    row.constraints.rows[0].compliance = 1.1 / 1.6;  // the spring would push less
    EXPECT_NEAR(row.residual(), 0.1 / 3.8, 1e-12);
}

TEST(KktCertificate, LetsNoNaNOfRowsPass)
{
    WithRow multiplier, coefficient, lower;
    multiplier.row_multipliers[0] = kNaN;
    EXPECT_TRUE(std::isnan(multiplier.residual()));
    coefficient.constraints.rows[0].entries[0].second = kNaN;
    EXPECT_TRUE(std::isnan(coefficient.residual()));
    lower.constraints.rows[0].lower = kNaN;
    EXPECT_TRUE(std::isnan(lower.residual()));
}

}  // namespace
}  // namespace arris
