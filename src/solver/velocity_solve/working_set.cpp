// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/working_set.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/velocity_solve/dense_solve.h"

namespace arris {

using Matrix = Eigen::SparseMatrix<double>;

WorkingSet::WorkingSet(const PinnedBase& base)
    : base_(&base),
      is_member_(base.is_pinned.size(), 0),
      is_row_member_(base.constraints->rows.size(), 0),
      columns_(*base.factorization)
{
}

void WorkingSet::see_new_rows()
{
    is_row_member_.resize(base_->constraints->rows.size(), 0);
}

void WorkingSet::enter(std::vector<Member>& added, Member member)
{
    char& is_in = member.kind == Kind::Row ? is_row_member_[member.index] : is_member_[member.index];
    assert(!is_in);
    is_in = 1;
    added.push_back(member);
}

void WorkingSet::release_pins_of(const std::vector<int>& rows, std::vector<Member>& added)
{
    for (const int row : rows)
        for (const auto& [coordinate, coefficient] : base_->constraints->rows[row].entries)
            if (base_->is_pinned[coordinate] && !is_member_[coordinate]) {
                enter(added, {Kind::Released, coordinate});
                ++followers_;
            }
}

/// Position in the elimination order; for a row, that of its first entry.
int WorkingSet::position_of(const Member& member) const
{
    const std::vector<int>& position = base_->factorization->position();
    if (member.kind != Kind::Row) return position[member.index];
    int first = static_cast<int>(position.size());
    for (const auto& [coordinate, coefficient] : row_of(member).entries)
        if (!base_->is_pinned[coordinate]) first = std::min(first, position[coordinate]);
    return first;
}

void WorkingSet::extend(const std::vector<int>& coordinates, const std::vector<int>& rows)
{
    std::vector<Member> added;
    for (const int coordinate : coordinates)
        enter(added, {base_->is_pinned[coordinate] ? Kind::Released : Kind::Stopped, coordinate});
    for (const int row : rows) enter(added, {Kind::Row, row});
    row_count_ += static_cast<int>(rows.size());
    release_pins_of(rows, added);
    // Neighbours in elimination order share their paths.
    std::stable_sort(added.begin(), added.end(),
                     [&](const Member& a, const Member& b) { return position_of(a) < position_of(b); });

    const int old_size = size(), new_size = old_size + static_cast<int>(added.size());
    members_.insert(members_.end(), added.begin(), added.end());
    multipliers_.conservativeResize(new_size);
    multipliers_.tail(new_size - old_size).setZero();
    direct_.conservativeResize(new_size, new_size);
    direct_.rightCols(new_size - old_size).setZero();
    direct_.bottomRows(new_size - old_size).setZero();
    columns_.append(right_hand_sides(added));
}

/// A_FR for a released pin, a unit vector for a stopped coordinate, the free coefficients of a row.
std::vector<SparseVector> WorkingSet::right_hand_sides(const std::vector<Member>& added)
{
    const int first = size() - static_cast<int>(added.size());
    std::vector<SparseVector> result(added.size());
    std::vector<int> place(is_member_.size(), -1);  // in U, of the released pins
    bool is_any_released = false;
    for (int k = 0; k < size(); ++k)
        if (members_[k].kind == Kind::Released) place[members_[k].index] = k;
    for (std::size_t k = 0; k < added.size(); ++k) {
        is_any_released |= added[k].kind == Kind::Released;
        if (added[k].kind == Kind::Stopped) result[k].emplace_back(added[k].index, 1.0);
        if (added[k].kind == Kind::Row) add_row(first + static_cast<int>(k), place, result[k]);
    }
    if (is_any_released) add_released(first, place, result);
    return result;
}

void WorkingSet::add_row(int member, const std::vector<int>& place, SparseVector& column)
{
    for (const auto& [coordinate, coefficient] : row_of(members_[member]).entries) {
        const int k = place[coordinate];
        if (!base_->is_pinned[coordinate])
            column.emplace_back(coordinate, coefficient);
        else
            direct_(k, member) = direct_(member, k) = coefficient;
    }
}

/// One pass over the lower triangle finds A_RR and the columns of all pins released from member `first` on.
void WorkingSet::add_released(int first, const std::vector<int>& place, std::vector<SparseVector>& columns)
{
    const Matrix& matrix = base_->matrix();
    const auto enter_column = [&](int released, int other, double value) {
        if (released >= first && !base_->is_pinned[other])
            columns[released - first].emplace_back(other, value);
    };
    for (int column = 0; column < matrix.cols(); ++column)
        for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
            const int row = static_cast<int>(entry.row());
            if (row < column) continue;
            const int k = place[row], l = place[column];
            if (k >= 0 && l >= 0) direct_(k, l) = direct_(l, k) = entry.value();
            if (k >= 0) enter_column(k, column, entry.value());
            if (l >= 0) enter_column(l, row, entry.value());
        }
}

/// Entry of [C, B; -B^T, Y^T Y], the matrix of (dR, lambda_a).
double WorkingSet::mixed(int i, int j) const
{
    const double rest = columns_.gram()(i, j) - direct_(i, j);
    return members_[j].kind == Kind::Released ? -rest : rest;
}

std::optional<CondensedQp> WorkingSet::condense(const MemberSprings& springs) const
{
    const Eigen::MatrixXd& gram = columns_.gram();
    std::vector<int> released, stopped;  // rows count as stopped
    for (int k = 0; k < size(); ++k) (members_[k].kind == Kind::Released ? released : stopped).push_back(k);
    CondensedQp qp = {gram, Eigen::VectorXd(size())};
    for (const int k : stopped) {
        qp.hessian(k, k) += give_of(members_[k]);
        qp.linear[k] = gap_of(members_[k], base_->iterate);
    }
    if (!released.empty() && !release_pins(released, stopped, qp)) return std::nullopt;
    take_out_springs(springs, qp);
    add_discs(qp);
    return qp;
}

/// S and q by eliminating dR = C^-1 (lambda_R - gradient0_R - B lambda_a).
bool WorkingSet::release_pins(const std::vector<int>& released, const std::vector<int>& stopped,
                              CondensedQp& qp) const
{
    const Eigen::MatrixXd& gram = columns_.gram();
    Eigen::VectorXd gradient(static_cast<Eigen::Index>(released.size()));
    for (std::size_t k = 0; k < released.size(); ++k)
        gradient[static_cast<Eigen::Index>(k)] = base_->iterate.gradient[members_[released[k]].index];
    const Eigen::LLT<Eigen::MatrixXd> stiffness(direct_(released, released) - gram(released, released));
    if (stiffness.info() != Eigen::Success) return false;
    const Eigen::MatrixXd compliance =
        stiffness.solve(Eigen::MatrixXd::Identity(gradient.size(), gradient.size()));
    const Eigen::VectorXd step = stiffness.solve(gradient);
    qp.hessian(released, released) = 0.5 * (compliance + compliance.transpose());
    qp.linear(released) = -step;
    if (stopped.empty()) return true;

    const Eigen::MatrixXd coupling = gram(released, stopped) - direct_(released, stopped);
    const Eigen::MatrixXd moved = stiffness.solve(coupling);
    qp.hessian(released, stopped) = -moved;
    qp.hessian(stopped, released) = -moved.transpose();
    qp.hessian(stopped, stopped) += coupling.transpose() * moved;
    qp.linear(stopped) += coupling.transpose() * step;
    return true;
}

MemberSprings WorkingSet::springs_of_members() const
{
    const ConstraintRows& constraints = *base_->constraints;
    MemberSprings springs;
    for (int k = 0; k < size(); ++k)
        if (is_spring(members_[k]) || is_slip(members_[k])) springs.members.push_back(k);
    const auto count = static_cast<Eigen::Index>(springs.members.size());
    springs.force = Eigen::VectorXd::Zero(count);
    springs.gives.resize(count);
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<int> place(members_.size(), -1);
    for (int i = 0; i < count; ++i) {
        const int k = springs.members[i];
        place[k] = i;
        springs.gives[i] = row_of(members_[k]).give;
        if (is_spring(members_[k])) entries.emplace_back(i, i, 1.0 / row_of(members_[k]).give);
    }
    const std::vector<std::array<int, 2>> of_pairs = places_of_pairs();
    for (std::size_t p = 0; p < of_pairs.size(); ++p) {
        if (of_pairs[p][0] < 0) continue;
        const SlipSpring& base = base_->slips[p];
        const std::array<int, 2> at = {place[of_pairs[p][0]], place[of_pairs[p][1]]};
        springs.force(at) = base.at({constraints.rows[2 * p].lower, constraints.rows[2 * p + 1].lower});
        if (!base.is_in_matrix()) continue;
        for (const int i : {0, 1})
            for (const int j : {0, 1}) entries.emplace_back(at[i], at[j], base.stiffness(i, j));
    }
    springs.stiffness.resize(count, count);
    springs.stiffness.setFromTriplets(entries.begin(), entries.end());
    return springs;
}

void WorkingSet::add_discs(CondensedQp& qp) const
{
    const std::vector<std::array<int, 2>> place = places_of_pairs();
    for (std::size_t p = 0; p < place.size(); ++p)
        if (place[p][0] >= 0) qp.discs.push_back({place[p][0], place[p][1], base_->constraints->budgets[p]});
}

/// The members that are a friction pair's two slip rows, by pair; -1 for pairs outside U.
std::vector<std::array<int, 2>> WorkingSet::places_of_pairs() const
{
    std::vector<std::array<int, 2>> place(base_->slips.size(), {-1, -1});
    for (int k = 0; k < size(); ++k)
        if (is_slip(members_[k])) place[members_[k].index / 2][members_[k].index % 2] = k;
    return place;
}

/// u - lower, or g^T u - lower + give * multiplier.
double WorkingSet::gap_of(const Member& member, const Iterate& iterate) const
{
    if (is_slip(member) || is_spring(member)) return gap(row_of(member), iterate.velocity, 0.0);
    if (member.kind == Kind::Row)
        return gap(row_of(member), iterate.velocity, iterate.row_multipliers[member.index]);
    return iterate.velocity[member.index] - base_->problem->lower[member.index];
}

bool WorkingSet::solve(Iterate& iterate, int& nlopt_evaluations, DenseBudget& budget)
{
    const double released = static_cast<double>(std::count_if(
        members_.begin(), members_.end(), [](const Member& m) { return m.kind == Kind::Released; }));
    if (!budget.spend(2.0 * released * released * static_cast<double>(size()))) return false;
    const MemberSprings springs = springs_of_members();
    const std::optional<CondensedQp> qp = condense(springs);
    if (!qp) return false;
    const std::optional<CondensedAnswer> answer = solve_condensed_qp(*qp, multipliers_, budget);
    if (!answer) return false;
    nlopt_evaluations += answer->nlopt_evaluations;
    multipliers_ = answer->z;

    // f = f0 - W dR + Y lambda_a; then one backward solve.
    iterate = base_->iterate;
    Eigen::VectorXd coefficients(size());
    for (int k = 0; k < size(); ++k)
        coefficients[k] = members_[k].kind == Kind::Released ? -answer->w[k] : answer->z[k];
    coefficients(springs.members) = beyond_springs(springs, *answer);
    Eigen::VectorXd forward = base_->forward;
    columns_.accumulate(coefficients, forward);
    set_members(*answer, base_->factorization->solve_backward(forward), iterate);
    return true;
}

void WorkingSet::set_members(const CondensedAnswer& answer, const Eigen::VectorXd& free,
                             Iterate& iterate) const
{
    for (int i = 0; i < free.size(); ++i)
        if (!base_->is_pinned[i]) iterate.velocity[i] = free[i];
    for (int k = 0; k < size(); ++k) set_member(k, answer, iterate);
    evaluate_gradient(*base_, iterate);
}

void WorkingSet::set_member(int k, const CondensedAnswer& answer, Iterate& iterate) const
{
    const auto [kind, i] = members_[k];
    if (kind == Kind::Row) {
        iterate.row_multipliers[i] = answer.z[k];
        iterate.has_let_go[i] = is_spring(members_[k]) && !answer.is_positive[k];
        if (is_slip(members_[k])) iterate.is_exact[i / 2] = 1;
        return;
    }
    iterate.is_active[i] = answer.is_positive[k];
    if (kind == Kind::Released || iterate.is_active[i]) {
        const double gap = iterate.is_active[i] ? 0.0 : answer.w[k];
        iterate.velocity[i] = base_->problem->lower[i] + gap;
    }
}

/// Whether refinement treats the member as an equation: pins that are free now, coordinates stopped now, rows
/// that press, and springs of the base that do not act. Impulses of friction stay as they are.
bool WorkingSet::is_equation(const Member& member, const Iterate& iterate) const
{
    if (member.kind != Kind::Row)
        return (member.kind == Kind::Released) != (iterate.is_active[member.index] != 0);
    if (is_slip(member)) return base_->slips[member.index / 2].is_in_matrix();
    if (is_spring(member)) return iterate.has_let_go[member.index] != 0;
    return iterate.row_multipliers[member.index] > 0.0;
}

/// With r = -gradient on the free coordinates: L f = P r, then (dR, lambda_a), then one backward solve.
bool WorkingSet::refine(Iterate& iterate) const
{
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(iterate.velocity.size());
    for (int i = 0; i < residual.size(); ++i)
        if (!base_->is_pinned[i] && !iterate.is_active[i]) residual[i] = -iterate.gradient[i];
    Eigen::VectorXd forward = base_->factorization->solve_forward(residual);
    std::vector<int> equations;
    for (int k = 0; k < size(); ++k)
        if (is_equation(members_[k], iterate)) equations.push_back(k);

    const Eigen::VectorXd step = step_of(equations, iterate, forward);
    if (!step.allFinite()) return false;
    if (!equations.empty()) {
        Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(size());
        for (std::size_t i = 0; i < equations.size(); ++i) {
            const double change = step[static_cast<Eigen::Index>(i)];
            coefficients[equations[i]] = members_[equations[i]].kind == Kind::Released ? -change : change;
        }
        columns_.accumulate(coefficients, forward);
    }
    const Eigen::VectorXd free = base_->factorization->solve_backward(forward);
    Eigen::VectorXd correction = Eigen::VectorXd::Zero(free.size());
    for (int i = 0; i < free.size(); ++i)
        if (!base_->is_pinned[i] && !iterate.is_active[i]) correction[i] = free[i];
    for (std::size_t i = 0; i < equations.size(); ++i) {
        const Member& member = members_[equations[i]];
        const double change = step[static_cast<Eigen::Index>(i)];
        if (member.kind == Kind::Released) correction[member.index] += change;
        if (member.kind != Kind::Row || is_slip(member) || is_spring(member)) continue;
        double& multiplier = iterate.row_multipliers[member.index];
        multiplier = std::max(multiplier + change, 0.0);
    }
    correct(*base_, correction, iterate);
    return true;
}

/// (dR, lambda_a) from [C, B; -B^T, Y^T Y] (dR; lambda) = (r_R - W^T f; -gap_a - Y^T f). The gap of a bound
/// is exactly zero. What has a spring K in the base gets lambda = K dy in place of its row, which takes the
/// spring out: its multiplier does not change with dy = Y^T f + [-B^T, Y^T Y] (dR; lambda).
Eigen::VectorXd WorkingSet::step_of(const std::vector<int>& equations, const Iterate& iterate,
                                    const Eigen::VectorXd& forward) const
{
    const auto count = static_cast<Eigen::Index>(equations.size());
    if (count == 0) return {};
    const Eigen::VectorXd product = columns_.dot(forward);
    const std::vector<std::array<int, 2>> place = places_of_pairs();
    Eigen::MatrixXd matrix(count, count);
    Eigen::VectorXd rhs(count), scale(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const int k = equations[i];
        const Member& member = members_[k];
        double known = 0.0;
        if (member.kind == Kind::Released) known = -iterate.gradient[member.index];
        if (member.kind == Kind::Row && !is_spring(member)) known = -gap_of(member, iterate);
        rhs[i] = known - product[k];
        for (Eigen::Index j = 0; j < count; ++j) matrix(i, j) = mixed(k, equations[j]);
        matrix(i, i) += is_spring(member) ? -row_of(member).give : give_of(member);
        if (is_slip(member)) {
            const double unit = columns_.gram()(k, k);  // 1/kg
            matrix.row(i).setZero();
            matrix(i, i) = unit;
            rhs[i] = 0.0;
            const int pair = member.index / 2;
            for (int d = 0; d < 2; ++d) {
                const int l = place[pair][d];
                const double stiffness = unit * base_->slips[pair].stiffness(member.index % 2, d);
                rhs[i] += stiffness * product[l];
                for (Eigen::Index j = 0; j < count; ++j) matrix(i, j) -= stiffness * mixed(l, equations[j]);
            }
        }
        scale[i] = 1.0 / std::sqrt(std::abs(matrix(i, i)));
    }
    // Members have different units: scale to a unit diagonal first.
    matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
    return scale.cwiseProduct(solve_dense(std::move(matrix), scale.cwiseProduct(rhs)).col(0));
}

}  // namespace arris
