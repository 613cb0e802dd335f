// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/condensed_qp.h"

#include <cblas.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/velocity_solve/condensed_descent.h"
#include "solver/velocity_solve/nlopt_outcome.h"

namespace arris {
namespace {

/// Diagonal shift with which Cholesky factorises a unit-diagonal matrix that is singular to round-off. Two
/// refinements remove the error of the shift.
constexpr double kShift = 1e-12;
constexpr int kRefinements = 2;

/// Signs smaller than this, relative to the largest z or w, are round-off.
constexpr double kSignTolerance = 1e-13;

/// Exchanges of the whole infeasible set allowed without a new least count (p of Judice and Pires 1994).
constexpr int kPatience = 10;

/// S, q and caps scaled so that S has a unit diagonal: z = scale * y.
struct ScaledQp {
    Eigen::VectorXd scale;
    CondensedQp qp;
};

bool has_caps(const CondensedQp& qp)
{
    return qp.cap.size() > 0;
}

double cap_of(const CondensedQp& qp, Eigen::Index i)
{
    return has_caps(qp) ? qp.cap[i] : std::numeric_limits<double>::infinity();
}

std::optional<ScaledQp> to_unit_diagonal(const CondensedQp& qp)
{
    if (!qp.hessian.allFinite() || !qp.linear.allFinite()) return std::nullopt;
    if (!(qp.hessian.diagonal().array() > 0.0).all()) return std::nullopt;
    ScaledQp scaled;
    scaled.scale = qp.hessian.diagonal().array().rsqrt();
    scaled.qp.hessian = scaled.scale.asDiagonal() * qp.hessian * scaled.scale.asDiagonal();
    scaled.qp.linear = scaled.scale.cwiseProduct(qp.linear);
    if (has_caps(qp)) scaled.qp.cap = qp.cap.cwiseQuotient(scaled.scale);
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

std::vector<double> to_std(const Eigen::VectorXd& vector)
{
    return {vector.begin(), vector.end()};
}

/// Minimiser y, computed in units of |q|: the solution of (S, q / unit) is y / unit.
Eigen::VectorXd minimise(const CondensedQp& qp, const Eigen::VectorXd& start, int& evaluations)
{
    const int size = static_cast<int>(qp.linear.size());
    const double unit = qp.linear.lpNorm<Eigen::Infinity>() / kTypicalUnknown;
    Objective objective = {&qp.hessian, qp.linear / unit, Eigen::VectorXd(size)};
    std::vector<double> x(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) x[i] = std::min(std::max(start[i] / unit, 0.0), cap_of(qp, i) / unit);

    nlopt::opt optimizer(nlopt::LD_LBFGS, static_cast<unsigned>(size));
    optimizer.set_vector_storage(kStoredVectors);
    optimizer.set_lower_bounds(0.0);
    if (has_caps(qp)) optimizer.set_upper_bounds(to_std(qp.cap / unit));
    optimizer.set_min_objective(evaluate, &objective);
    optimizer.set_ftol_rel(1e-12);
    optimizer.set_maxeval(std::min(4 * size + 100, 2000));
    improve(optimizer, x);
    evaluations += optimizer.get_numevals();
    return unit * Eigen::Map<const Eigen::VectorXd>(x.data(), size);
}

std::vector<int> those_that_stand(Stand stand, const CondensedAnswer& answer)
{
    std::vector<int> result;
    for (int i = 0; i < static_cast<int>(answer.stand.size()); ++i)
        if (answer.stand[i] == stand) result.push_back(i);
    return result;
}

/// S_AA z_A = -q_A - S_AC cap_C, z = cap on C, 0 elsewhere. False where S_AA is not positive definite even
/// with the shift.
bool solve_on_set(const CondensedQp& qp, CondensedAnswer& answer)
{
    const std::vector<int> set = those_that_stand(Stand::Between, answer);
    answer.z.setZero();
    for (const int i : those_that_stand(Stand::AtCap, answer)) answer.z[i] = qp.cap[i];
    const Eigen::MatrixXd part = qp.hessian(set, set);
    Eigen::MatrixXd shifted = part;
    shifted.diagonal().array() += kShift;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(shifted);
    if (cholesky.info() != Eigen::Success) return false;
    Eigen::VectorXd rhs = -qp.linear(set);
    if (has_caps(qp)) {
        multiply(qp.hessian, answer.z.data(), answer.w.data());
        rhs -= answer.w(set);
    }
    Eigen::VectorXd z = cholesky.solve(rhs);
    for (int refinement = 0; refinement < kRefinements; ++refinement) z += cholesky.solve(rhs - part * z);
    for (std::size_t k = 0; k < set.size(); ++k) answer.z[set[k]] = z[static_cast<Eigen::Index>(k)];
    multiply(qp.hessian, answer.z.data(), answer.w.data());
    answer.w += qp.linear;
    for (const int i : set) answer.w[i] = 0.0;
    return answer.z.allFinite() && answer.w.allFinite();
}

/// The state that unknown i should have instead; nothing where its state is right.
std::optional<Stand> better_stand(const CondensedQp& qp, const CondensedAnswer& answer, double least_z,
                                  double least_w, int i)
{
    switch (answer.stand[i]) {
        case Stand::AtZero:
            if (answer.w[i] < least_w) return Stand::Between;
            break;
        case Stand::Between:
            if (answer.z[i] < least_z) return Stand::AtZero;
            if (answer.z[i] > cap_of(qp, i) - least_z) return Stand::AtCap;
            break;
        case Stand::AtCap:
            if (answer.w[i] > -least_w) return Stand::Between;
            break;
    }
    return std::nullopt;
}

struct Exchange {
    int index;
    Stand stand;
};

std::vector<Exchange> infeasible(const CondensedQp& qp, const CondensedAnswer& answer)
{
    const double least_z = -kSignTolerance * answer.z.lpNorm<Eigen::Infinity>();
    const double least_w = -kSignTolerance * answer.w.lpNorm<Eigen::Infinity>();
    std::vector<Exchange> result;
    for (int i = 0; i < answer.z.size(); ++i)
        if (const auto stand = better_stand(qp, answer, least_z, least_w, i)) result.push_back({i, *stand});
    return result;
}

/// Block principal pivoting, then Murty's exchange of one index, always the last, once blocks stop helping. A
/// positive definite S is a P-matrix, for which Murty's rule ends from any set. With caps S may be
/// semidefinite, where no rule need end: false then.
bool pivot(const CondensedQp& qp, CondensedAnswer& answer)
{
    const int size = static_cast<int>(qp.linear.size());
    std::size_t least = static_cast<std::size_t>(size) + 1;
    int patience = kPatience;
    for (int step = 0; step < 20 * size + 50; ++step) {
        if (!solve_on_set(qp, answer)) return false;
        const std::vector<Exchange> wrong = infeasible(qp, answer);
        if (wrong.empty()) return true;
        const bool is_better = wrong.size() < least;
        if (is_better) {
            least = wrong.size();
            patience = kPatience;
        }
        const bool is_block = is_better || patience-- > 0;
        if (!is_block && has_caps(qp)) return false;
        if (is_block)
            for (const auto& [index, stand] : wrong) answer.stand[index] = stand;
        else
            answer.stand[wrong.back().index] = wrong.back().stand;
    }
    return false;
}

/// Clamping to the bounds removes round-off only.
CondensedAnswer to_given_units(const CondensedQp& qp, const ScaledQp& scaled, CondensedAnswer answer)
{
    answer.z = scaled.scale.cwiseProduct(answer.z).cwiseMax(0.0);
    answer.w = answer.w.cwiseQuotient(scaled.scale);
    for (Eigen::Index i = 0; i < answer.z.size(); ++i) {
        const bool is_capped = answer.stand[i] == Stand::AtCap;
        answer.z[i] = is_capped ? qp.cap[i] : std::min(answer.z[i], cap_of(qp, i));
        if (answer.stand[i] == Stand::Between) answer.w[i] = 0.0;
        answer.w[i] = is_capped ? std::min(answer.w[i], 0.0) : std::max(answer.w[i], 0.0);
    }
    return answer;
}

CondensedAnswer answer_from(Eigen::VectorXd z, std::vector<Stand> stand)
{
    return {std::move(z), Eigen::VectorXd::Zero(static_cast<Eigen::Index>(stand.size())), std::move(stand)};
}

}  // namespace

std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<Stand> stand)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled) return std::nullopt;
    CondensedAnswer answer = answer_from(Eigen::VectorXd::Zero(qp.linear.size()), std::move(stand));
    if (!pivot(scaled->qp, answer)) return std::nullopt;
    return to_given_units(qp, *scaled, std::move(answer));
}

std::optional<CondensedAnswer> solve_by_descent(const CondensedQp& qp, const Eigen::VectorXd& z,
                                                const Eigen::VectorXd& gap)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled || !z.allFinite() || !gap.allFinite()) return std::nullopt;
    const KnownGap known = {z.cwiseQuotient(scaled->scale), gap.cwiseProduct(scaled->scale)};
    CondensedAnswer answer =
        answer_from(known.z, std::vector<Stand>(static_cast<std::size_t>(z.size()), Stand::Between));
    if (!descend(scaled->qp, known, answer)) return std::nullopt;
    return to_given_units(qp, *scaled, std::move(answer));
}

std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start)
{
    const std::optional<ScaledQp> scaled = to_unit_diagonal(qp);
    if (!scaled) return std::nullopt;
    std::vector<Stand> stand(static_cast<std::size_t>(qp.linear.size()), Stand::AtZero);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(qp.linear.size());
    int evaluations = 0;
    if (scaled->qp.linear.minCoeff() < 0.0) {  // else z = 0
        y = minimise(scaled->qp, start.cwiseQuotient(scaled->scale), evaluations);
        const Eigen::VectorXd gradient = scaled->qp.hessian * y + scaled->qp.linear;
        for (int i = 0; i < y.size(); ++i)
            if (y[i] > gradient[i])
                stand[i] = y[i] - gradient[i] < cap_of(scaled->qp, i) ? Stand::Between : Stand::AtCap;
    }
    CondensedAnswer answer = answer_from(y, std::move(stand));
    if (!pivot(scaled->qp, answer)) {
        if (!has_caps(qp)) return std::nullopt;
        answer.z = y;
        const KnownGap known = {Eigen::VectorXd::Zero(y.size()), scaled->qp.linear};
        if (!descend(scaled->qp, known, answer)) return std::nullopt;
    }
    answer.nlopt_evaluations = evaluations;
    return to_given_units(qp, *scaled, std::move(answer));
}

}  // namespace arris
