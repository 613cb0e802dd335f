// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/condensed_qp.h"
#include "solver/factorization.h"
#include "solver/forward_columns.h"
#include "solver/velocity_solve.h"

namespace arris {

/// A velocity, which bounds it takes as active (u = lower there), and what is left of the equations.
struct Iterate {
    Eigen::VectorXd velocity;
    std::vector<char> is_active;
    Eigen::VectorXd gradient;   ///< A u - b: the multiplier where active, a residual where free
    Eigen::VectorXd magnitude;  ///< |A||u| + |b|: what round-off in `gradient` is measured by
};

/// The problem with chosen bounds pinned, solved by one factorisation:
/// u = lower where pinned, 0 where fixed, and A_FF u_F = b_F - A_FP u_P on the free coordinates F.
struct PinnedBase {
    const VelocityProblem* problem;
    const Factorization* factorization;
    std::vector<char> is_pinned;  ///< a guessed bound or a fixed coordinate: not in the factor
    Eigen::VectorXd forward;      ///< f = L^-1 P (b_F - A_FP u_P)
    Iterate iterate;
};

/// The gradient and magnitude that belong to `iterate.velocity`.
void evaluate_gradient(const VelocityProblem& problem, Iterate& iterate);

/// What the factor leaves out when these bounds are active: them and the fixed coordinates.
std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active);

/// `factorization` is the matrix's with `find_pinned(problem, is_active)`.
PinnedBase solve_pinned(const VelocityProblem& problem, const std::vector<char>& is_active,
                        const Factorization& factorization);

/// The coordinates U whose bounds may have to change sides against the base: pins to be released (R) and free
/// coordinates to be stopped (a). Everything else is eliminated by the base's factor: with W = L^-1 P A_FR
/// and Y = L^-1 P E_a, of which `columns` holds the Gram matrix, the base's solution changes by
///   gradient_R = gradient0_R + C dR + B lambda_a,   C = A_RR - W^T W  (compliance^-1 of the released)
///   gap_a      = gap0_a - B^T dR + Y^T Y lambda_a,   B = W^T Y
/// with dR = u_R - lower_R. Solved for (dR, gap_a) it is w = S lambda + q, where S = ((A_F+R)^-1)_UU is SPD:
/// the condensed problem. U only grows. A general row would be one more column Y = L^-1 P g_F.
class WorkingSet {
  public:
    explicit WorkingSet(const PinnedBase& base);

    int size() const { return static_cast<int>(members_.size()); }
    bool contains(int coordinate) const { return is_member_[coordinate]; }
    void extend(std::vector<int> coordinates);

    /// Finds multipliers on U, and with them the velocity. False where the dense problem is not positive
    /// definite to working precision or does not end; the working set is of no use then.
    bool solve(Iterate& iterate, int& nlopt_evaluations);

    /// One step of iterative refinement of the equations of the present active set; false as above.
    bool refine(Iterate& iterate) const;

  private:
    struct Member {
        int coordinate;
        bool is_released;  ///< else stopped
    };
    std::vector<SparseVector> right_hand_sides(const std::vector<Member>& added);
    std::optional<CondensedQp> condense() const;
    double mixed(int i, int j) const;

    const PinnedBase* base_;
    std::vector<char> is_member_;  ///< by coordinate
    std::vector<Member> members_;
    ForwardColumns columns_;
    Eigen::MatrixXd released_;  ///< A_ij where both are released, 0 elsewhere; U x U
    Eigen::VectorXd multipliers_;
};

}  // namespace arris
