// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/working_set.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "solver/symmetric_product.h"

namespace arris {

using Matrix = Eigen::SparseMatrix<double>;

void evaluate_gradient(const VelocityProblem& problem, Iterate& iterate)
{
    SymmetricProduct product = symmetric_product_with_magnitude(*problem.matrix, iterate.velocity);
    iterate.gradient = std::move(product.value) - *problem.rhs;
    iterate.magnitude = std::move(product.magnitude) + problem.rhs->cwiseAbs();
}

std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active)
{
    std::vector<char> is_pinned = is_active;
    for (std::size_t i = 0; i < is_pinned.size(); ++i) is_pinned[i] = is_active[i] || problem.is_fixed[i];
    return is_pinned;
}

PinnedBase solve_pinned(const VelocityProblem& problem, const std::vector<char>& is_active,
                        const Factorization& factorization)
{
    PinnedBase base = {&problem, &factorization, find_pinned(problem, is_active), {}, {}};
    Eigen::VectorXd held = Eigen::VectorXd::Zero(problem.rhs->size());
    for (int i = 0; i < held.size(); ++i)
        if (is_active[i]) held[i] = problem.lower[i];
    Eigen::VectorXd rhs = *problem.rhs - symmetric_product(*problem.matrix, held);
    for (int i = 0; i < held.size(); ++i)
        if (base.is_pinned[i]) rhs[i] = 0.0;

    base.forward = factorization.solve_forward(rhs);
    base.iterate = {factorization.solve_backward(base.forward) + held, is_active, {}, {}};
    evaluate_gradient(problem, base.iterate);
    return base;
}

WorkingSet::WorkingSet(const PinnedBase& base)
    : base_(&base), is_member_(base.is_pinned.size(), 0), columns_(*base.factorization)
{
}

void WorkingSet::extend(std::vector<int> coordinates)
{
    // Neighbours in elimination order share their paths.
    const std::vector<int>& position = base_->factorization->position();
    std::sort(coordinates.begin(), coordinates.end(),
              [&](int a, int b) { return position[a] < position[b]; });
    std::vector<Member> added;
    for (const int coordinate : coordinates) {
        is_member_[coordinate] = 1;
        added.push_back({coordinate, base_->is_pinned[coordinate] != 0});
    }
    const int old_size = size(), new_size = old_size + static_cast<int>(added.size());
    members_.insert(members_.end(), added.begin(), added.end());
    multipliers_.conservativeResize(new_size);
    multipliers_.tail(new_size - old_size).setZero();
    released_.conservativeResize(new_size, new_size);
    released_.rightCols(new_size - old_size).setZero();
    released_.bottomRows(new_size - old_size).setZero();
    columns_.append(right_hand_sides(added));
}

/// A_FR for a pin released, a unit vector for a coordinate stopped. One pass over the lower triangle finds
/// all the released columns, and A_RR with them.
std::vector<SparseVector> WorkingSet::right_hand_sides(const std::vector<Member>& added)
{
    const int first = size() - static_cast<int>(added.size());
    std::vector<SparseVector> result(added.size());
    std::vector<int> place(is_member_.size(), -1);  // in U, of the released
    bool is_any_released = false;
    for (int k = 0; k < size(); ++k)
        if (members_[k].is_released) place[members_[k].coordinate] = k;
    for (std::size_t k = 0; k < added.size(); ++k) {
        is_any_released |= added[k].is_released;
        if (!added[k].is_released) result[k].emplace_back(added[k].coordinate, 1.0);
    }
    if (!is_any_released) return result;

    const Matrix& matrix = *base_->problem->matrix;
    const auto enter = [&](int released, int other, double value) {
        if (released >= first && !base_->is_pinned[other])
            result[released - first].emplace_back(other, value);
    };
    for (int column = 0; column < matrix.cols(); ++column)
        for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
            const int row = static_cast<int>(entry.row());
            if (row < column) continue;
            const int k = place[row], l = place[column];
            if (k >= 0 && l >= 0) released_(k, l) = released_(l, k) = entry.value();
            if (k >= 0) enter(k, column, entry.value());
            if (l >= 0) enter(l, row, entry.value());
        }
    return result;
}

/// Entry of [C, B; -B^T, Y^T Y], the matrix of (dR, lambda_a).
double WorkingSet::mixed(int i, int j) const
{
    const double product = columns_.gram()(i, j);
    if (members_[i].is_released) return members_[j].is_released ? released_(i, j) - product : product;
    return members_[j].is_released ? -product : product;
}

/// S and q by eliminating dR = C^-1 (lambda_R - gradient0_R - B lambda_a).
std::optional<CondensedQp> WorkingSet::condense() const
{
    const Eigen::MatrixXd& gram = columns_.gram();
    std::vector<int> released, stopped;
    for (int k = 0; k < size(); ++k) (members_[k].is_released ? released : stopped).push_back(k);
    CondensedQp qp = {gram, Eigen::VectorXd(size())};
    for (const int k : stopped)
        qp.linear[k] =
            base_->iterate.velocity[members_[k].coordinate] - base_->problem->lower[members_[k].coordinate];
    if (released.empty()) return qp;

    Eigen::VectorXd gradient(static_cast<Eigen::Index>(released.size()));
    for (std::size_t k = 0; k < released.size(); ++k)
        gradient[static_cast<Eigen::Index>(k)] = base_->iterate.gradient[members_[released[k]].coordinate];
    const Eigen::LLT<Eigen::MatrixXd> stiffness(released_(released, released) - gram(released, released));
    if (stiffness.info() != Eigen::Success) return std::nullopt;
    const Eigen::MatrixXd compliance =
        stiffness.solve(Eigen::MatrixXd::Identity(gradient.size(), gradient.size()));
    const Eigen::VectorXd step = stiffness.solve(gradient);
    qp.hessian(released, released) = 0.5 * (compliance + compliance.transpose());
    qp.linear(released) = -step;
    if (stopped.empty()) return qp;

    const Eigen::MatrixXd coupling = gram(released, stopped);
    const Eigen::MatrixXd moved = stiffness.solve(coupling);
    qp.hessian(released, stopped) = -moved;
    qp.hessian(stopped, released) = -moved.transpose();
    qp.hessian(stopped, stopped) += coupling.transpose() * moved;
    qp.linear(stopped) += coupling.transpose() * step;
    return qp;
}

bool WorkingSet::solve(Iterate& iterate, int& nlopt_evaluations)
{
    const std::optional<CondensedQp> qp = condense();
    if (!qp) return false;
    const std::optional<CondensedAnswer> answer = solve_condensed_qp(*qp, multipliers_);
    if (!answer) return false;
    nlopt_evaluations += answer->nlopt_evaluations;
    multipliers_ = answer->z;

    // f = f0 - W dR + Y lambda_a; then one backward solve.
    iterate = base_->iterate;
    Eigen::VectorXd coefficients(size());
    for (int k = 0; k < size(); ++k) coefficients[k] = members_[k].is_released ? -answer->w[k] : answer->z[k];
    Eigen::VectorXd forward = base_->forward;
    columns_.accumulate(coefficients, forward);
    Eigen::VectorXd free = base_->factorization->solve_backward(forward);
    for (int i = 0; i < free.size(); ++i)
        if (!base_->is_pinned[i]) iterate.velocity[i] = free[i];
    for (int k = 0; k < size(); ++k) {
        const int i = members_[k].coordinate;
        iterate.is_active[i] = answer->is_positive[k];
        if (members_[k].is_released || iterate.is_active[i]) {
            const double gap = iterate.is_active[i] ? 0.0 : answer->w[k];
            iterate.velocity[i] = base_->problem->lower[i] + gap;
        }
    }
    evaluate_gradient(*base_->problem, iterate);
    return true;
}

/// With r = -gradient on the free coordinates: L f = P r, then (dR, lambda_a) over the released that stayed
/// free and the stopped that stayed active, from [C, B; -B^T, Y^T Y] (dR; lambda) = (r_R - W^T f; -Y^T f).
bool WorkingSet::refine(Iterate& iterate) const
{
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(iterate.velocity.size());
    for (int i = 0; i < residual.size(); ++i)
        if (!base_->is_pinned[i] && !iterate.is_active[i]) residual[i] = -iterate.gradient[i];
    Eigen::VectorXd forward = base_->factorization->solve_forward(residual);
    std::vector<int> changed;
    for (int k = 0; k < size(); ++k)
        if (members_[k].is_released != (iterate.is_active[members_[k].coordinate] != 0)) changed.push_back(k);

    Eigen::VectorXd step;
    if (!changed.empty()) {
        const auto count = static_cast<Eigen::Index>(changed.size());
        const Eigen::VectorXd product = columns_.dot(forward);
        Eigen::MatrixXd matrix(count, count);
        Eigen::VectorXd rhs(count), scale(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            const Member& member = members_[changed[i]];
            scale[i] = 1.0 / std::sqrt(std::abs(mixed(changed[i], changed[i])));
            rhs[i] = (member.is_released ? -iterate.gradient[member.coordinate] : 0.0) - product[changed[i]];
            for (Eigen::Index j = 0; j < count; ++j) matrix(i, j) = mixed(changed[i], changed[j]);
        }
        // Rows and columns have different units: to a unit diagonal first.
        matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
        step = scale.cwiseProduct(matrix.partialPivLu().solve(scale.cwiseProduct(rhs)));
        if (!step.allFinite()) return false;
        Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(size());
        for (Eigen::Index i = 0; i < count; ++i)
            coefficients[changed[i]] = members_[changed[i]].is_released ? -step[i] : step[i];
        columns_.accumulate(coefficients, forward);
    }
    const Eigen::VectorXd free = base_->factorization->solve_backward(forward);
    for (int i = 0; i < free.size(); ++i)
        if (!base_->is_pinned[i] && !iterate.is_active[i]) iterate.velocity[i] += free[i];
    for (std::size_t i = 0; i < changed.size(); ++i)
        if (members_[changed[i]].is_released)
            iterate.velocity[members_[changed[i]].coordinate] += step[static_cast<Eigen::Index>(i)];
    evaluate_gradient(*base_->problem, iterate);
    return true;
}

}  // namespace arris
