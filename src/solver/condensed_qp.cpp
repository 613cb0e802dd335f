// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/condensed_qp.h"

#include <cblas.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "solver/nlopt_outcome.h"

namespace arris {
namespace {

/// Shift that lets Cholesky pass a unit-diagonal matrix singular to round-off; two refinements take it out
/// again.
constexpr double kShift = 1e-12;
constexpr int kRefinements = 2;

/// Signs smaller than this, relative to the largest z or w, are round-off.
constexpr double kSignTolerance = 1e-13;

/// Exchanges of the whole infeasible set that may pass without a new least count (Judice and Pires 1994, p).
constexpr int kPatience = 10;

/// S and q scaled to a unit diagonal: z = scale * y.
struct ScaledQp {
    Eigen::VectorXd scale;
    CondensedQp qp;
};

std::optional<ScaledQp> to_unit_diagonal(const CondensedQp& qp)
{
    if (!qp.hessian.allFinite() || !qp.linear.allFinite()) return std::nullopt;
    if (!(qp.hessian.diagonal().array() > 0.0).all()) return std::nullopt;
    ScaledQp scaled;
    scaled.scale = qp.hessian.diagonal().array().rsqrt();
    scaled.qp.hessian = scaled.scale.asDiagonal() * qp.hessian * scaled.scale.asDiagonal();
    scaled.qp.linear = scaled.scale.cwiseProduct(qp.linear);
    if (!scaled.scale.allFinite() || !scaled.qp.hessian.allFinite() || !scaled.qp.linear.allFinite())
        return std::nullopt;
    return scaled;
}

void multiply(const Eigen::MatrixXd& matrix, const double* x, double* product)
{
    const int size = static_cast<int>(matrix.rows());
    cblas_dgemv(CblasColMajor, CblasNoTrans, size, size, 1.0, matrix.data(), size, x, 1, 0.0, product, 1);
}

struct Objective {
    const Eigen::MatrixXd* hessian;
    Eigen::VectorXd linear, product;
};

double evaluate(const std::vector<double>& x, std::vector<double>& gradient, void* data)
{
    Objective& objective = *static_cast<Objective*>(data);
    const Eigen::Map<const Eigen::VectorXd> point(x.data(), static_cast<Eigen::Index>(x.size()));
    multiply(*objective.hessian, x.data(), objective.product.data());
    const double value = 0.5 * point.dot(objective.product) + point.dot(objective.linear);
    if (!std::isfinite(value)) throw nlopt::forced_stop();
    for (std::size_t i = 0; i < gradient.size(); ++i)
        gradient[i] = objective.product[i] + objective.linear[i];
    return value;
}

/// y with its units divided out: the solution of (S, q / unit) is y / unit.
Eigen::VectorXd minimise(const CondensedQp& qp, const Eigen::VectorXd& start, int& evaluations)
{
    const int size = static_cast<int>(qp.linear.size());
    const double unit = qp.linear.lpNorm<Eigen::Infinity>() / kTypicalUnknown;
    Objective objective = {&qp.hessian, qp.linear / unit, Eigen::VectorXd(size)};
    std::vector<double> x(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) x[i] = std::max(start[i] / unit, 0.0);

    nlopt::opt optimizer(nlopt::LD_LBFGS, static_cast<unsigned>(size));
    optimizer.set_vector_storage(kStoredVectors);
    optimizer.set_lower_bounds(0.0);
    optimizer.set_min_objective(evaluate, &objective);
    optimizer.set_ftol_rel(1e-12);
    optimizer.set_maxeval(std::min(4 * size + 100, 2000));
    improve(optimizer, x);
    evaluations += optimizer.get_numevals();
    return unit * Eigen::Map<const Eigen::VectorXd>(x.data(), size);
}

std::vector<int> positions(const std::vector<char>& is_positive)
{
    std::vector<int> result;
    for (int i = 0; i < static_cast<int>(is_positive.size()); ++i)
        if (is_positive[i]) result.push_back(i);
    return result;
}

/// S_AA z_A = -q_A, z = 0 elsewhere. False where S_AA is not positive definite even with the shift.
bool solve_on_set(const CondensedQp& qp, CondensedAnswer& answer)
{
    const std::vector<int> set = positions(answer.is_positive);
    answer.z.setZero();
    const Eigen::MatrixXd part = qp.hessian(set, set);
    Eigen::MatrixXd shifted = part;
    shifted.diagonal().array() += kShift;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(shifted);
    if (cholesky.info() != Eigen::Success) return false;
    const Eigen::VectorXd rhs = -qp.linear(set);
    Eigen::VectorXd z = cholesky.solve(rhs);
    for (int refinement = 0; refinement < kRefinements; ++refinement) z += cholesky.solve(rhs - part * z);
    answer.z(set) = z;
    multiply(qp.hessian, answer.z.data(), answer.w.data());
    answer.w += qp.linear;
    answer.w(set).setZero();
    return answer.z.allFinite() && answer.w.allFinite();
}

std::vector<int> infeasible(const CondensedAnswer& answer)
{
    const double least_z = -kSignTolerance * answer.z.lpNorm<Eigen::Infinity>();
    const double least_w = -kSignTolerance * answer.w.lpNorm<Eigen::Infinity>();
    std::vector<int> result;
    for (int i = 0; i < answer.z.size(); ++i)
        if (answer.is_positive[i] ? answer.z[i] < least_z : answer.w[i] < least_w) result.push_back(i);
    return result;
}

/// Block principal pivoting; Murty's exchange of one index, always the last, when blocks stop helping. S is a
/// P-matrix, for which Murty's rule ends from any set, so that the whole is finite.
bool pivot(const CondensedQp& qp, CondensedAnswer& answer)
{
    const int size = static_cast<int>(qp.linear.size());
    std::size_t least = static_cast<std::size_t>(size) + 1;
    int patience = kPatience;
    for (int step = 0; step < 20 * size + 50; ++step) {
        if (!solve_on_set(qp, answer)) return false;
        const std::vector<int> wrong = infeasible(answer);
        if (wrong.empty()) return true;
        const bool is_better = wrong.size() < least;
        if (is_better) {
            least = wrong.size();
            patience = kPatience;
        }
        if (is_better || patience-- > 0)
            for (const int i : wrong) answer.is_positive[i] = !answer.is_positive[i];
        else
            answer.is_positive[wrong.back()] = !answer.is_positive[wrong.back()];
    }
    return false;
}

std::optional<CondensedAnswer> pivot_scaled(const ScaledQp& scaled, std::vector<char> is_positive)
{
    const auto size = scaled.qp.linear.size();
    CondensedAnswer answer = {Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size),
                              std::move(is_positive)};
    if (!pivot(scaled.qp, answer)) return std::nullopt;
    // What is left below zero is round-off.
    answer.z = scaled.scale.cwiseProduct(answer.z).cwiseMax(0.0);
    answer.w = answer.w.cwiseQuotient(scaled.scale).cwiseMax(0.0);
    return answer;
}

}  // namespace

std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<char> is_positive)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled) return std::nullopt;
    return pivot_scaled(*scaled, std::move(is_positive));
}

std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled) return std::nullopt;
    std::vector<char> is_positive(static_cast<std::size_t>(qp.linear.size()), 0);
    int evaluations = 0;
    if (scaled->qp.linear.minCoeff() < 0.0) {  // else z = 0
        const Eigen::VectorXd y = minimise(scaled->qp, start.cwiseQuotient(scaled->scale), evaluations);
        const Eigen::VectorXd gradient = scaled->qp.hessian * y + scaled->qp.linear;
        for (int i = 0; i < y.size(); ++i) is_positive[i] = y[i] > gradient[i];
    }
    std::optional<CondensedAnswer> answer = pivot_scaled(*scaled, std::move(is_positive));
    if (answer) answer->nlopt_evaluations = evaluations;
    return answer;
}

}  // namespace arris
