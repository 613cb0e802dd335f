// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/seam_spring.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

namespace arris {
namespace {

constexpr double kStep = 1e-6, kTolerance = 1e-7;

struct Pulled {
    std::array<Vec3, 2> force;
    Eigen::Matrix<double, 6, 6> stiffness;
};

/// Force and stiffness: with gamma = 1 and everything at rest the system is M + K, and its right side f.
Pulled evaluate(const SpringElement& spring, const std::vector<Vec3>& x)
{
    Linearization at;
    at.gamma = 1.0;
    at.damping = {0.5};  // of a piece; springs have none
    at.position = x;
    at.v_predicted = at.v_expansion = at.v_last = at.drift = std::vector<Vec3>(2, Vec3::Zero());
    at.basis.assign(2, Mat3::Identity());
    at.has_basis.assign(2, 0);
    SpringSystem system(at, spring.vertices, kUndamped);
    SeamSpring().add(SpringState(spring, x), system);
    Pulled pulled{{system.rhs(0), system.rhs(1)}, {}};
    pulled.stiffness << system.matrix(0, 0), system.matrix(1, 0).transpose(), system.matrix(1, 0),
        system.matrix(1, 1);
    return pulled;
}

double energy(const SpringElement& spring, const std::vector<Vec3>& x)
{
    return SeamSpring().energy(SpringState(spring, x));
}

TEST(SeamSpring, ForceAndStiffnessAreDerivativesOfTheEnergy)
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (const double length : {0.0, 0.1, 0.4}) {
        std::vector<Vec3> x(2);
        for (Vec3& p : x) p = Vec3(uniform(random), uniform(random), uniform(random));
        x[1] += (x[1] - x[0]).normalized();
        const SpringElement spring = {{0, 1}, 3.0, length};
        const Pulled at = evaluate(spring, x);
        for (int v = 0; v < 2; ++v)
            for (int c = 0; c < 3; ++c) {
                std::vector<Vec3> ahead = x, behind = x;
                ahead[v][c] += kStep;
                behind[v][c] -= kStep;
                EXPECT_NEAR(at.force[v][c], -(energy(spring, ahead) - energy(spring, behind)) / (2.0 * kStep),
                            kTolerance);
                for (int w = 0; w < 2; ++w) {
                    const Vec3 change =
                        (evaluate(spring, ahead).force[w] - evaluate(spring, behind).force[w]) /
                        (2.0 * kStep);
                    EXPECT_LT((at.stiffness.block<3, 1>(3 * w, 3 * v + c) + change).norm(), kTolerance);
                }
            }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> values(at.stiffness);
        EXPECT_GT(values.eigenvalues().minCoeff(), -1e-12);
    }
}

TEST(SeamSpring, SlackAndIdleOnesDoNothing)
{
    const std::vector<Vec3> x = {Vec3::Zero(), Vec3(0.3, 0.0, 0.0)};
    for (const SpringElement& spring : {SpringElement{{0, 1}, 3.0, 0.31}, SpringElement{{0, 1}, 0.0, 0.0}}) {
        EXPECT_EQ(energy(spring, x), 0.0);
        EXPECT_EQ(evaluate(spring, x).force[0], Vec3::Zero());
        EXPECT_TRUE(evaluate(spring, x).stiffness.isZero(0.0));
    }
    const std::vector<Vec3> together(2, Vec3(1.0, 2.0, 3.0));
    const Pulled closed = evaluate({{0, 1}, 3.0, 0.0}, together);
    EXPECT_EQ(closed.force[0], Vec3::Zero());
    EXPECT_EQ((closed.stiffness.block<3, 3>(0, 0)), Mat3(3.0 * Mat3::Identity()));
    EXPECT_TRUE(evaluate({{0, 1}, 3.0, 0.1}, together).stiffness.isZero(0.0)) << "slack, without a direction";
}

}  // namespace
}  // namespace arris
