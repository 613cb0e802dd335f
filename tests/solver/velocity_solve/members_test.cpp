// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/members.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "solver/velocity_solve/symmetric_product.h"
#include "tests/solver/cloth_system.h"
#include "tests/solver/row_problems.h"

namespace arris {
namespace {

/// A small cloth on its floor with rows, of which the base has every third as a spring, and every other bound
/// pinned.
class MembersOfACloth : public ::testing::Test {
  protected:
    void SetUp() override
    {
        VelocityProblem& problem = owned.problem;
        problem.is_fixed[0] = problem.is_fixed[1] = problem.is_fixed[2] = 1;
        const VelocitySolution resting = VelocitySolver().solve(problem, Settings());
        problem.rows =
            testing::make_rows(shape(), resting.velocity, testing::RowPattern::Spread, 20, 0.01, 3);
        constraints = scale_rows(problem, estimate_free_speed(problem));
        factorization.analyse(owned.matrix);
        state.is_active.assign(problem.is_fixed.size(), 0);
        for (int i = 0; i < problem.lower.size(); ++i) {
            if (problem.is_fixed[i] || std::isinf(problem.lower[i])) continue;
            bounds.push_back(i);
            state.is_active[i] = bounds.size() % 2 == 0;
        }
        state.is_pressing.assign(constraints.rows.size(), 0);
        for (int k = 0; k < static_cast<int>(constraints.rows.size()); ++k) {
            if (constraints.rows[k].entries.empty()) continue;
            rows.push_back(k);
            state.is_pressing[k] = k % 3 == 0;
        }
        base.emplace(problem, constraints, factorization);
        ASSERT_TRUE(base->factorise(state));
    }

    static testing::ClothShape shape()
    {
        testing::ClothShape small;
        small.side = 6;
        return small;
    }

    /// The change of the velocity by a dense solve: pinned coordinates stay, but for members; members push
    /// with `forces`.
    Eigen::VectorXd dense_change(const Members& members, const Eigen::VectorXd& residual,
                                 const Eigen::VectorXd& forces) const
    {
        Eigen::MatrixXd A = testing::dense_symmetric(base->matrix());
        Eigen::VectorXd b = residual;
        for (int k = 0; k < members.size(); ++k) {
            const Member& member = members[k];
            if (member.is_bound())
                b[member.index] += forces[k];
            else
                for (const auto& [i, a] : constraints.rows[member.index].entries) b[i] += a * forces[k];
        }
        for (int i = 0; i < b.size(); ++i) {
            if (!base->is_pinned(i) || members.has_bound(i)) continue;
            A.row(i).setZero();
            A.col(i).setZero();
            A(i, i) = 1.0;
            b[i] = 0.0;
        }
        return A.lu().solve(b);
    }

    testing::OwnedProblem owned = testing::make_resting_cloth(shape(), 0.6);
    ConstraintRows constraints;
    Factorization factorization;
    ContactState state;
    std::optional<SpringBase> base;
    std::vector<int> bounds, rows;
};

TEST_F(MembersOfACloth, RespondAsADenseSolveDoes)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto noise = [&](Eigen::Index size) {
        return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); }));
    };
    const Eigen::VectorXd velocity = noise(owned.rhs.size()), values = noise(constraints.rows.size());
    Eigen::VectorXd residual = noise(owned.rhs.size());
    for (int i = 0; i < 3; ++i) residual[i] = 0.0;
    DenseBudget unlimited = {std::numeric_limits<double>::infinity()};
    Members members(*base, owned.problem, constraints, unlimited);
    for (std::size_t first = 0; first < bounds.size();
         first += 7) {  // grows in any order to the same response
        std::vector<int> some;
        for (std::size_t k = first; k < std::min(first + 7, bounds.size()); ++k)
            if (!members.has_bound(bounds[k])) some.push_back(bounds[k]);
        members.extend(some,
                       first / 7 < rows.size() ? std::vector<int>{rows[first / 7]} : std::vector<int>{});
        const Eigen::VectorXd forward = base->solve_forward(residual);
        const auto response = members.respond(velocity, values, residual, forward);
        ASSERT_TRUE(response);
        const Eigen::VectorXd forces = noise(members.size());
        const Eigen::VectorXd change = members.change(forces, forward);
        const Eigen::VectorXd expected = dense_change(members, residual, forces);
        EXPECT_LE((change - expected).norm(), 1e-9 * expected.norm());
        const Eigen::VectorXd displacement = response->now + response->offset + response->mobility * forces;
        for (int k = 0; k < members.size(); ++k) {
            const Member& member = members[k];
            double moved = response->now[k];
            if (member.is_bound())
                moved += expected[member.index];
            else
                for (const auto& [i, a] : constraints.rows[member.index].entries) moved += a * expected[i];
            EXPECT_NEAR(displacement[k], moved, 1e-9 * displacement.norm());
        }
        EXPECT_LE((response->mobility - response->mobility.transpose()).norm(), 1e-12);
    }
}

TEST_F(MembersOfACloth, BaseHasTheSpringsOfItsState)
{
    Eigen::MatrixXd expected = testing::dense_symmetric(owned.matrix);
    for (const int k : rows) {
        if (!state.is_pressing[k]) continue;
        Eigen::VectorXd g = Eigen::VectorXd::Zero(expected.rows());
        for (const auto& [i, a] : constraints.rows[k].entries) g[i] = a;
        expected += g * g.transpose() / constraints.rows[k].compliance;
    }
    EXPECT_LE((testing::dense_symmetric(base->matrix()) - expected).norm(), 1e-13 * expected.norm());
}

}  // namespace
}  // namespace arris
