// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "solver/velocity_solve/condensed_qp.h"

namespace arris {

/// A row among the members: its force is max(0, -displacement) / compliance. What the base gives is `force` -
/// `base_stiffness` times the change of the displacement: nothing large cancels in it.
struct RowMember {
    int place;  ///< in the response
    double compliance, force, base_stiffness;
};

/// A bound among the members: its displacement is not negative. What counts is its force beyond `force`, the
/// last multiplier; where the bound has to be a stiff spring, the spring gives the rest.
struct BoundMember {
    int place;
    double force;
};

/// A friction pair among the members: its force is -displacement / compliance, projected onto the disc of the
/// budget. The base gives `force` - `base_stiffness` times the change of the displacement.
struct SlipMember {
    std::array<int, 2> place;
    double compliance, budget;
    Eigen::Vector2d force;
    Eigen::Matrix2d base_stiffness;
    Eigen::Vector2d impulse;  ///< of the last linear model; that of this solve's last one, on return
};

/// The members' laws with their response: displacement = now + offset + mobility * force beyond the base.
struct MemberProblem {
    Eigen::MatrixXd mobility;
    Eigen::VectorXd offset, now;
    std::vector<BoundMember> bounds;
    std::vector<RowMember> rows;
    std::vector<SlipMember> slipping;
};

/// Forces beyond the base, with an error below `tolerance` (N s) where possible. Without friction, NLopt and
/// pivoting find which members push, exactly. With friction, Newton's method on the springs' energy. Nothing
/// where the dense matrices are singular or the budget of work is spent.
std::optional<Eigen::VectorXd> solve_members(MemberProblem& problem, double tolerance, DenseBudget& budget,
                                             int& nlopt_evaluations);

}  // namespace arris
