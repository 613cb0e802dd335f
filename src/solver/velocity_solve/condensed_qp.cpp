// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/condensed_qp.h"

#include <cblas.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/velocity_solve/dense_solve.h"
#include "solver/velocity_solve/nlopt_outcome.h"

namespace arris {
namespace {

/// Exchanges of the whole infeasible set allowed without a new least count (p of Judice and Pires 1994).
constexpr int kPatience = 10;

/// S and q scaled so that S has a unit diagonal: z = scale * y.
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
    const DenseBudget* budget;
    Eigen::VectorXd linear, product;
};

double evaluate(const std::vector<double>& x, std::vector<double>& gradient, void* data)
{
    Objective& objective = *static_cast<Objective*>(data);
    if (objective.budget->is_interrupted()) throw nlopt::forced_stop();
    const Eigen::Map<const Eigen::VectorXd> point(x.data(), static_cast<Eigen::Index>(x.size()));
    multiply(*objective.hessian, x.data(), objective.product.data());
    const double value = 0.5 * point.dot(objective.product) + point.dot(objective.linear);
    if (!std::isfinite(value)) throw nlopt::forced_stop();
    for (std::size_t i = 0; i < gradient.size(); ++i)
        gradient[i] = objective.product[i] + objective.linear[i];
    return value;
}

/// Minimiser y, computed in units of |q|: the solution of (S, q / unit) is y / unit.
Eigen::VectorXd minimise(const CondensedQp& qp, const Eigen::VectorXd& start, const DenseBudget& budget,
                         int& evaluations)
{
    const int size = static_cast<int>(qp.linear.size());
    const double unit = qp.linear.lpNorm<Eigen::Infinity>() / kTypicalUnknown;
    Objective objective = {&qp.hessian, &budget, qp.linear / unit, Eigen::VectorXd(size)};
    std::vector<double> x(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) x[i] = std::max(start[i] / unit, 0.0);

    nlopt::opt optimizer(nlopt::LD_LBFGS, static_cast<unsigned>(size));
    optimizer.set_vector_storage(kStoredVectors);
    optimizer.set_lower_bounds(0.0);
    optimizer.set_min_objective(evaluate, &objective);
    optimizer.set_ftol_rel(1e-12);
    const double affordable = budget.flops / (2.0 * size * size);
    optimizer.set_maxeval(std::clamp(static_cast<int>(std::min(affordable, 2000.0)), 1, 4 * size + 100));
    improve(optimizer, x);
    evaluations += optimizer.get_numevals();
    return unit * Eigen::Map<const Eigen::VectorXd>(x.data(), size);
}

std::vector<int> positive(const CondensedAnswer& answer)
{
    std::vector<int> result;
    for (int i = 0; i < static_cast<int>(answer.is_positive.size()); ++i)
        if (answer.is_positive[i]) result.push_back(i);
    return result;
}

/// S_AA z_A = -q_A on the positive unknowns A, z = 0 elsewhere. `round_off` of z is what its last refinement
/// changed. False where S_AA is not positive definite even with the shift.
bool solve_on_set(const CondensedQp& qp, CondensedAnswer& answer, double& round_off)
{
    const std::vector<int> set = positive(answer);
    answer.z.setZero();
    const Eigen::MatrixXd part = qp.hessian(set, set);
    Eigen::MatrixXd shifted = part;
    shifted.diagonal().array() += kShift;
    const std::optional<RefinedSolution> solved = solve_refined(part, shifted, -qp.linear(set));
    if (!solved) return false;
    round_off = solved->last_change;
    for (std::size_t k = 0; k < set.size(); ++k) answer.z[set[k]] = solved->x[static_cast<Eigen::Index>(k)];
    multiply(qp.hessian, answer.z.data(), answer.w.data());
    answer.w += qp.linear;
    for (const int i : set) answer.w[i] = 0.0;
    return answer.z.allFinite() && answer.w.allFinite();
}

/// Floating-point operations of `solve_on_set`, nearly.
double cost_of_set(const CondensedAnswer& answer)
{
    const double size = static_cast<double>(answer.is_positive.size()),
                 set = static_cast<double>(std::count_if(answer.is_positive.begin(), answer.is_positive.end(),
                                                         [](char is) { return is; }));
    return set * set * set / 3.0 + 10.0 * size * size;
}

/// Unknowns with the wrong sign of z or w, ascending. |S_ij| <= 1, so w = S z + q has the round-off of |z|_1.
std::vector<int> find_wrong(const CondensedAnswer& answer, double round_off_of_z)
{
    constexpr double kEpsilon = 4.0 * std::numeric_limits<double>::epsilon();
    const double least_z = -std::max(kSignTolerance * answer.z.lpNorm<Eigen::Infinity>(), round_off_of_z);
    const double least_w =
        -std::max(kSignTolerance * answer.w.lpNorm<Eigen::Infinity>(), kEpsilon * answer.z.lpNorm<1>());
    std::vector<int> wrong;
    for (int i = 0; i < answer.z.size(); ++i)
        if (answer.is_positive[i] ? answer.z[i] < least_z : answer.w[i] < least_w) wrong.push_back(i);
    return wrong;
}

/// Block principal pivoting, then Murty's exchange of one index, always the last, once blocks stop helping. A
/// positive definite S is a P-matrix, for which Murty's rule ends from any set.
bool pivot(const CondensedQp& qp, DenseBudget& budget, CondensedAnswer& answer)
{
    const int size = static_cast<int>(qp.linear.size());
    std::size_t least = static_cast<std::size_t>(size) + 1;
    int patience = kPatience;
    for (int step = 0; step < 20 * size + 50; ++step) {
        double round_off = 0.0;
        if (!budget.spend(cost_of_set(answer)) || !solve_on_set(qp, answer, round_off)) return false;
        const std::vector<int> wrong = find_wrong(answer, round_off);
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

/// Clamping at zero removes round-off only.
CondensedAnswer to_given_units(const ScaledQp& scaled, CondensedAnswer answer)
{
    answer.z = scaled.scale.cwiseProduct(answer.z).cwiseMax(0.0);
    answer.w = answer.w.cwiseQuotient(scaled.scale).cwiseMax(0.0);
    return answer;
}

CondensedAnswer start_from(std::vector<char> is_positive)
{
    const auto size = static_cast<Eigen::Index>(is_positive.size());
    return {Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size), std::move(is_positive)};
}

}  // namespace

std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<char> is_positive)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled) return std::nullopt;
    CondensedAnswer answer = start_from(std::move(is_positive));
    DenseBudget unlimited = {std::numeric_limits<double>::infinity()};
    if (!pivot(scaled->qp, unlimited, answer)) return std::nullopt;
    return to_given_units(*scaled, std::move(answer));
}

std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start,
                                                  DenseBudget& budget)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled) return std::nullopt;
    CondensedAnswer answer = start_from(std::vector<char>(static_cast<std::size_t>(qp.linear.size()), false));
    if (scaled->qp.linear.minCoeff() < 0.0) {  // else z = 0
        const Eigen::VectorXd y =
            minimise(scaled->qp, start.cwiseQuotient(scaled->scale), budget, answer.nlopt_evaluations);
        if (!budget.spend(2.0 * static_cast<double>(y.size() * y.size()) * answer.nlopt_evaluations))
            return std::nullopt;
        const Eigen::VectorXd gradient = scaled->qp.hessian * y + scaled->qp.linear;
        for (int i = 0; i < y.size(); ++i) answer.is_positive[i] = y[i] > gradient[i];
    }
    if (!pivot(scaled->qp, budget, answer)) return std::nullopt;
    return to_given_units(*scaled, std::move(answer));
}

}  // namespace arris
