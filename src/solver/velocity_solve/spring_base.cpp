// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/spring_base.h"

#include <algorithm>

namespace arris {

SpringBase::SpringBase(const VelocityProblem& problem, const ConstraintRows& constraints,
                       Factorization& factorization)
    : problem_(&problem),
      constraints_(&constraints),
      factorization_(&factorization),
      is_pinned_(problem.is_fixed)
{
    for (int p = 0; p < constraints.pair_count(); ++p) {
        Spring& spring = pairs_.emplace_back();
        for (int d = 0; d < 2; ++d) enter(constraints.rows[2 * p + d], d, spring);
        find_blocks(spring);
    }
    see_new_rows();
}

void SpringBase::see_new_rows()
{
    for (std::size_t k = constraints_->slip_count() + rows_.size(); k < constraints_->rows.size(); ++k) {
        Spring& spring = rows_.emplace_back();
        enter(constraints_->rows[k], 0, spring);
        find_blocks(spring);
    }
    state_.is_pressing.resize(constraints_->rows.size(), 0);
}

/// Adds a row's coefficients as this column of the spring's directions.
void SpringBase::enter(const ScaledRow& row, int column, Spring& spring) const
{
    for (const auto& [coordinate, coefficient] : row.entries) {
        const auto begin = spring.vertex.begin(), end = begin + spring.vertex_count;
        const auto at = std::lower_bound(begin, end, coordinate / 3);
        const auto i = at - begin;
        if (at == end || *at != coordinate / 3) {
            if (spring.vertex_count == kMostVertices) {
                spring.has_room = false;
                return;
            }
            std::move_backward(at, end, end + 1);
            const auto first = spring.direction.begin() + i;
            std::move_backward(first, spring.direction.begin() + spring.vertex_count,
                               spring.direction.begin() + spring.vertex_count + 1);
            spring.vertex[i] = coordinate / 3;
            spring.direction[i].setZero();
            ++spring.vertex_count;
        }
        spring.direction[i](coordinate % 3, column) = coefficient;
    }
}

/// The three columns of a vertex have the same rows, in whole blocks: one search a block.
void SpringBase::find_blocks(Spring& spring) const
{
    const int *outer = problem_->matrix->outerIndexPtr(), *inner = problem_->matrix->innerIndexPtr();
    if (!spring.has_room) return;
    for (int i = 0, k = 0; i < spring.vertex_count; ++i)
        for (int j = 0; j <= i; ++j, ++k) {
            const int row = 3 * spring.vertex[i], column = 3 * spring.vertex[j];
            const int *begin = inner + outer[column], *end = inner + outer[column + 1];
            const int* at = std::lower_bound(begin, end, row);
            if (at == end || *at != row) {
                spring.has_room = false;
                return;
            }
            spring.block[k] = static_cast<int>(at - inner);
        }
}

void SpringBase::add(const Spring& spring, const Eigen::Matrix2d& stiffness)
{
    if (!has_springs_) matrix_ = *problem_->matrix;
    has_springs_ = true;
    const int* outer = matrix_.outerIndexPtr();
    for (int i = 0, k = 0; i < spring.vertex_count; ++i) {
        const Eigen::Matrix<double, 3, 2> force = spring.direction[i] * stiffness;
        for (int j = 0; j <= i; ++j, ++k) {
            const Eigen::Matrix3d block = force * spring.direction[j].transpose();
            const int column = 3 * spring.vertex[j], height = outer[column + 1] - outer[column];
            double* value = matrix_.valuePtr() + spring.block[k];
            for (int c = 0; c < 3; ++c, value += height)
                for (int r = 0; r < 3; ++r) value[r] += block(r, c);
        }
    }
}

bool SpringBase::factorise(const ContactState& wanted)
{
    has_springs_ = false;
    state_ = wanted;
    const int first = constraints_->slip_count();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        char& is_pressing = state_.is_pressing[first + k];
        if (!rows_[k].has_room) is_pressing = 0;
        if (!is_pressing) continue;
        Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
        stiffness(0, 0) = 1.0 / constraints_->rows[first + k].compliance;
        add(rows_[k], stiffness);
    }
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        if (!pairs_[p].has_room) state_.stiffness[p].setZero();
        if (!state_.stiffness[p].isZero(0.0)) add(pairs_[p], state_.stiffness[p]);
    }
    for (std::size_t i = 0; i < is_pinned_.size(); ++i)
        is_pinned_[i] = state_.is_active[i] || problem_->is_fixed[i];
    return factorization_->factorise(matrix(), is_pinned_);
}

Eigen::VectorXd SpringBase::solve_forward(Eigen::VectorXd rhs) const
{
    for (int i = 0; i < rhs.size(); ++i)
        if (is_pinned_[i]) rhs[i] = 0.0;
    return factorization_->solve_forward(rhs);
}

Eigen::VectorXd SpringBase::solve_backward(const Eigen::VectorXd& forward) const
{
    Eigen::VectorXd solution = factorization_->solve_backward(forward);
    for (int i = 0; i < solution.size(); ++i)
        if (is_pinned_[i]) solution[i] = 0.0;
    return solution;
}

}  // namespace arris
