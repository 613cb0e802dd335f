// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/members.h"

#include <algorithm>
#include <cassert>

namespace arris {

using Matrix = Eigen::SparseMatrix<double>;

Members::Members(const SpringBase& base, const VelocityProblem& problem, const ConstraintRows& constraints,
                 DenseBudget& work)
    : base_(&base),
      problem_(&problem),
      constraints_(&constraints),
      work_(&work),
      is_bound_member_(problem.is_fixed.size(), 0),
      is_row_member_(constraints.rows.size(), 0),
      columns_(base.factorization())
{
}

void Members::see_new_rows()
{
    is_row_member_.resize(constraints_->rows.size(), 0);
}

void Members::enter(Member member, std::vector<Member>& added)
{
    char& is_in = member.is_bound() ? is_bound_member_[member.index] : is_row_member_[member.index];
    assert(!is_in);
    is_in = 1;
    added.push_back(member);
}

/// Place in the elimination order; of a row, that of its first coordinate.
int Members::position_of(const Member& member) const
{
    const std::vector<int>& position = base_->factorization().position();
    if (member.is_bound()) return position[member.index];
    const RowEntries& entries = constraints_->rows[member.index].entries;
    return entries.empty() ? 0 : position[entries.front().first];
}

void Members::extend(const std::vector<int>& bounds, const std::vector<int>& rows)
{
    std::vector<Member> added;
    for (const int i : bounds)
        enter({base_->is_pinned(i) ? Member::Kind::Released : Member::Kind::Stopped, i}, added);
    for (const int k : rows) {
        enter({k < constraints_->slip_count() ? Member::Kind::Slip : Member::Kind::Row, k}, added);
        for (const auto& [coordinate, coefficient] : constraints_->rows[k].entries)
            if (base_->is_pinned(coordinate) && !is_bound_member_[coordinate])
                enter({Member::Kind::Released, coordinate}, added);
    }
    if (added.empty()) return;
    // Neighbours in elimination order share their paths.
    std::stable_sort(added.begin(), added.end(),
                     [&](const Member& a, const Member& b) { return position_of(a) < position_of(b); });
    const int old_size = size(), new_size = old_size + static_cast<int>(added.size());
    members_.insert(members_.end(), added.begin(), added.end());
    direct_.conservativeResize(new_size, new_size);
    direct_.rightCols(new_size - old_size).setZero();
    direct_.bottomRows(new_size - old_size).setZero();
    const double before = columns_.flops();
    columns_.append(right_hand_sides(added));
    work_->flops -= columns_.flops() - before;
    is_condensed_ = false;
}

/// A'_FR for a released pin, a unit vector for a stopped coordinate, the free coefficients of a row.
std::vector<SparseVector> Members::right_hand_sides(const std::vector<Member>& added)
{
    const int first = size() - static_cast<int>(added.size());
    std::vector<SparseVector> result(added.size());
    std::vector<int> place(is_bound_member_.size(), -1);  // among the members, of the released pins
    bool is_any_released = false;
    for (int k = 0; k < size(); ++k)
        if (members_[k].kind == Member::Kind::Released) place[members_[k].index] = k;
    for (std::size_t k = 0; k < added.size(); ++k) {
        const int member = first + static_cast<int>(k);
        is_any_released |= added[k].kind == Member::Kind::Released;
        if (added[k].kind == Member::Kind::Stopped) result[k].emplace_back(added[k].index, 1.0);
        if (!added[k].is_bound()) add_row(member, place, result[k]);
    }
    if (is_any_released) add_released(first, place, result);
    return result;
}

void Members::add_row(int member, const std::vector<int>& place, SparseVector& column)
{
    for (const auto& [coordinate, coefficient] : constraints_->rows[members_[member].index].entries)
        if (base_->is_pinned(coordinate))
            direct_(place[coordinate], member) = direct_(member, place[coordinate]) = coefficient;
        else
            column.emplace_back(coordinate, coefficient);
}

/// One pass over the lower triangle finds A'_RR and the columns of all pins released from member `first` on.
void Members::add_released(int first, const std::vector<int>& place, std::vector<SparseVector>& columns)
{
    const Matrix& matrix = base_->matrix();
    const auto enter_column = [&](int released, int other, double value) {
        if (released >= first && !base_->is_pinned(other))
            columns[released - first].emplace_back(other, value);
    };
    const auto has_place = [&](int vertex) {
        return place[vertex] >= 0 || place[vertex + 1] >= 0 || place[vertex + 2] >= 0;
    };
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int vertex = 0; vertex < static_cast<int>(matrix.cols()); vertex += 3) {
        const bool is_wanted = has_place(vertex);
        const int height = outer[vertex + 1] - outer[vertex];
        for (int k = 0; k < height; k += 3) {  // whole blocks
            if (!is_wanted && !has_place(inner[outer[vertex] + k])) continue;
            for (int column = vertex; column < vertex + 3; ++column)
                for (int entry = outer[column] + k; entry < outer[column] + k + 3; ++entry) {
                    const int row = inner[entry];
                    if (row < column) continue;
                    const double value = matrix.valuePtr()[entry];
                    const int released_row = place[row], released_column = place[column];
                    if (released_row >= 0 && released_column >= 0)
                        direct_(released_row, released_column) = direct_(released_column, released_row) =
                            value;
                    if (released_row >= 0) enter_column(released_row, column, value);
                    if (released_column >= 0) enter_column(released_column, row, value);
                }
        }
    }
}

bool Members::condense()
{
    released_.clear();
    others_.clear();
    for (int k = 0; k < size(); ++k)
        (members_[k].kind == Member::Kind::Released ? released_ : others_).push_back(k);
    const Eigen::MatrixXd& gram = columns_.gram();
    mobility_ = gram;
    is_condensed_ = released_.empty();
    if (is_condensed_) return true;
    const auto count = static_cast<Eigen::Index>(released_.size());
    const double pins = static_cast<double>(released_.size()), others = static_cast<double>(others_.size());
    if (!work_->spend(pins * (7.0 / 3.0 * pins * pins + 2.0 * pins * others + 2.0 * others * others)))
        return false;
    stiffness_.compute(direct_(released_, released_) - gram(released_, released_));
    if (stiffness_.info() != Eigen::Success) return false;
    const Eigen::MatrixXd inverse = stiffness_.solve(Eigen::MatrixXd::Identity(count, count));
    mobility_(released_, released_) = 0.5 * (inverse + inverse.transpose());
    coupling_ = gram(released_, others_) - direct_(released_, others_);
    is_condensed_ = true;
    if (others_.empty()) return true;
    const Eigen::MatrixXd moved = stiffness_.solve(coupling_);
    mobility_(released_, others_) = -moved;
    mobility_(others_, released_) = -moved.transpose();
    const Eigen::MatrixXd more = coupling_.transpose() * moved;
    mobility_(others_, others_) += 0.5 * (more + more.transpose());
    return true;
}

std::optional<MemberResponse> Members::respond(const Eigen::VectorXd& velocity,
                                               const Eigen::VectorXd& row_values,
                                               const Eigen::VectorXd& residual,
                                               const Eigen::VectorXd& forward)
{
    if (!is_condensed_ && !condense()) return std::nullopt;
    MemberResponse response = {mobility_, columns_.dot(forward), Eigen::VectorXd(size())};
    if (!released_.empty()) {
        Eigen::VectorXd force(static_cast<Eigen::Index>(released_.size()));
        for (std::size_t k = 0; k < released_.size(); ++k)
            force[static_cast<Eigen::Index>(k)] =
                residual[members_[released_[k]].index] - response.offset[released_[k]];
        step_ = stiffness_.solve(force);
        response.offset(released_) = step_;
        response.offset(others_) -= coupling_.transpose() * step_;
    }
    for (int k = 0; k < size(); ++k) {
        const int i = members_[k].index;
        response.now[k] = members_[k].is_bound() ? velocity[i] - problem_->lower[i]
                                                 : row_values[i] - constraints_->rows[i].lower;
    }
    return response;
}

Eigen::VectorXd Members::change(const Eigen::VectorXd& forces, Eigen::VectorXd forward) const
{
    Eigen::VectorXd coefficients = forces, moved;
    if (!released_.empty()) {
        moved = step_ + stiffness_.solve(forces(released_) - coupling_ * forces(others_));
        coefficients(released_) = -moved;
    }
    if (size() > 0) columns_.accumulate(coefficients, forward);
    Eigen::VectorXd change = base_->solve_backward(forward);
    for (std::size_t k = 0; k < released_.size(); ++k)
        change[members_[released_[k]].index] = moved[static_cast<Eigen::Index>(k)];
    return change;
}

}  // namespace arris
