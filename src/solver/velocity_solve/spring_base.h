// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// Which bounds hold, which rows press, and with which stiffness friction acts: a linear model of all
/// contacts.
struct ContactState {
    std::vector<char> is_active;             ///< by coordinate: u = lower
    std::vector<char> is_pressing;           ///< by scaled row; slip rows are never set
    std::vector<Eigen::Matrix2d> stiffness;  ///< by friction pair, kg
};

/// The factor of A' = A + sum over pressing rows g g^T / compliance + sum over pairs g^T K g, without the
/// pinned coordinates (active bounds and fixed coordinates). A row or pair for which A has no entries is left
/// out of A'.
class SpringBase {
  public:
    SpringBase(const VelocityProblem& problem, const ConstraintRows& constraints,
               Factorization& factorization);

    /// Call after rows were appended to problem and constraints.
    void see_new_rows();

    /// False where A' is not positive definite.
    bool factorise(const ContactState& wanted);

    /// What the factor holds: `wanted`, as far as there is room.
    const ContactState& state() const { return state_; }
    bool is_pinned(int coordinate) const { return is_pinned_[coordinate]; }
    /// A'.
    const Eigen::SparseMatrix<double>& matrix() const { return has_springs_ ? matrix_ : *problem_->matrix; }
    const Factorization& factorization() const { return *factorization_; }

    Eigen::VectorXd solve_forward(Eigen::VectorXd rhs) const;  ///< L^-1 P rhs, with 0 at pinned coordinates
    Eigen::VectorXd solve_backward(const Eigen::VectorXd& forward) const;  ///< P^T L^-T forward, likewise

  private:
    static constexpr int kMostVertices = ConstraintRow::kMostEntries / 3;

    /// A row, or the two rows of a pair: coefficients by vertex, and the entries of A for each pair of
    /// vertices. There is no room for one with more vertices than contacts have.
    struct Spring {
        int vertex_count = 0;
        bool has_room = true;
        std::array<int, kMostVertices> vertex;                             ///< ascending
        std::array<Eigen::Matrix<double, 3, 2>, kMostVertices> direction;  ///< second column: of a pair
        std::array<int, kMostVertices*(kMostVertices + 1) / 2> block;      ///< entry (3 v_i, 3 v_j), i >= j
    };
    void enter(const ScaledRow& row, int column, Spring& spring) const;
    void find_blocks(Spring& spring) const;
    void add(const Spring& spring, const Eigen::Matrix2d& stiffness);

    const VelocityProblem* problem_;
    const ConstraintRows* constraints_;
    Factorization* factorization_;
    std::vector<Spring> pairs_, rows_;  ///< by friction pair; by row of the problem
    bool has_springs_ = false;
    Eigen::SparseMatrix<double> matrix_;  ///< A', where it has springs
    ContactState state_;
    std::vector<char> is_pinned_;
};

}  // namespace arris
