// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/member_solve.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/batches.h"
#include "solver/velocity_solve/dense_solve.h"
#include "solver/velocity_solve/line_search.h"
#include "solver/velocity_solve/slip_law.h"

namespace arris {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// With the springs of the base taken out, z are whole forces: with f the forces now and K the base's
/// stiffness, displacement = now + way + T (z - f), T = (1 - S K)^-1 S, way = (1 - S K)^-1 offset.
struct WithoutSprings {
    MatrixXd mobility;  ///< T
    VectorXd way, force;
};

std::optional<WithoutSprings> take_out_springs(const MemberProblem& problem, DenseBudget& budget)
{
    WithoutSprings result = {problem.mobility, problem.offset, VectorXd::Zero(problem.offset.size())};
    std::vector<int> in_base;
    VectorXd stiffness = VectorXd::Zero(problem.offset.size());
    for (const BoundMember& member : problem.bounds) result.force[member.place] = member.force;
    for (const RowMember& member : problem.rows) {
        result.force[member.place] = member.force;
        stiffness[member.place] = member.base_stiffness;
        if (member.base_stiffness > 0.0) in_base.push_back(member.place);
    }
    if (in_base.empty()) return result;
    const auto count = static_cast<Eigen::Index>(in_base.size()), size = problem.offset.size();
    const double k = static_cast<double>(count), n = static_cast<double>(size);
    if (!budget.spend(2.0 / 3.0 * k * k * k + 2.0 * k * k * n + 2.0 * k * n * n)) return std::nullopt;
    const MatrixXd columns = problem.mobility(Eigen::all, in_base);
    const MatrixXd stiff = columns * stiffness(in_base).asDiagonal();
    MatrixXd right(count, size + 1);
    right << columns.transpose(), problem.offset(in_base);
    const MatrixXd moved =
        solve_dense(MatrixXd::Identity(count, count) - stiff(in_base, Eigen::all), std::move(right));
    result.mobility += stiff * moved.leftCols(size);
    result.mobility = (0.5 * (result.mobility + result.mobility.transpose())).eval();
    result.way += stiff * moved.col(size);
    return result;
}

/// Forces beyond `free.force` of the members that push, where the others have none. Solved as a difference:
/// the forces themselves, which may be far larger, would leave their round-off. Not finite where the matrix
/// is singular.
VectorXd find_change_of_force(const CondensedQp& qp, const WithoutSprings& free, const VectorXd& gap,
                              const std::vector<char>& is_pushing, DenseBudget& budget)
{
    std::vector<int> pushing;
    VectorXd change = -free.force;
    for (Eigen::Index k = 0; k < gap.size(); ++k)
        if (is_pushing[k]) {
            pushing.push_back(static_cast<int>(k));
            change[k] = 0.0;
        }
    if (pushing.empty()) return change;
    const double k = static_cast<double>(pushing.size());
    budget.flops -= k * k * k / 3.0 + 6.0 * k * k;
    const VectorXd rhs = -(gap + free.way + qp.hessian * change)(pushing);
    const MatrixXd part = qp.hessian(pushing, pushing);
    MatrixXd shifted = part;
    shifted.diagonal() *= 1.0 + kShift;
    const std::optional<RefinedSolution> solved = solve_refined(part, shifted, rhs);
    if (!solved) return VectorXd::Constant(gap.size(), std::numeric_limits<double>::quiet_NaN());
    change(pushing) = solved->x;
    return change;
}

std::optional<VectorXd> push_by_nlopt(const MemberProblem& problem, DenseBudget& budget, int& evaluations)
{
    const std::optional<WithoutSprings> without = take_out_springs(problem, budget);
    if (!without) return std::nullopt;
    const WithoutSprings& free = *without;
    CondensedQp qp = {free.mobility, problem.now + free.way - free.mobility * free.force};
    VectorXd gap = problem.now;  // with the forces now
    for (const RowMember& member : problem.rows) {
        qp.hessian(member.place, member.place) += member.compliance;
        gap[member.place] += member.compliance * member.force;
    }
    const std::optional<CondensedAnswer> answer = solve_condensed_qp(qp, free.force.cwiseMax(0.0), budget);
    if (!answer) return std::nullopt;
    evaluations += answer->nlopt_evaluations;
    VectorXd beyond = find_change_of_force(qp, free, gap, answer->is_positive, budget);
    if (!beyond.allFinite()) return std::nullopt;
    const VectorXd change = free.way + free.mobility * beyond;
    for (const RowMember& member : problem.rows)
        beyond[member.place] += member.base_stiffness * change[member.place];
    return beyond;
}

/// Newton's method for z = psi(S z + q), psi the law's force beyond the base, q the offset. It is the
/// gradient of a convex energy 1/2 z^T S z + Psi(S z + q).
class MemberNewton {
  public:
    MemberNewton(MemberProblem& problem, DenseBudget& budget) : problem_(&problem), budget_(&budget) {}

    std::optional<VectorXd> run(double tolerance);

  private:
    /// Of the spring that stands for a bound.
    double compliance_of(const BoundMember& member) const
    {
        constexpr double kCompliance =
            1e-8;  // of the bound's mobility; with 1e-5 some problems do not converge
        return kCompliance * problem_->mobility(member.place, member.place);
    }
    VectorXd law_at(const VectorXd& change) const;
    bool take_step(bool does_search);
    void enter_slopes(const VectorXd& change);
    VectorXd slopes_times(const VectorXd& way) const;

    MemberProblem* problem_;
    DenseBudget* budget_;
    VectorXd force_, change_, error_;  ///< z, S z + q, psi - z
    std::vector<int> differing_;       ///< members whose stiffness is not that of the base
    MatrixXd slopes_;                  ///< by member: -dpsi / ddisplacement, own and of the partner
    std::vector<int> partner_;         ///< the other row of a pair; the member itself without one
};

VectorXd MemberNewton::law_at(const VectorXd& change) const
{
    VectorXd force = VectorXd::Zero(change.size());
    for (const BoundMember& member : problem_->bounds) {
        const double x = problem_->now[member.place] + change[member.place];
        force[member.place] = std::max(member.force - x / compliance_of(member), 0.0) - member.force;
    }
    for (const RowMember& member : problem_->rows) {
        const double x = problem_->now[member.place] + change[member.place];
        force[member.place] = (std::max(-x, 0.0) / member.compliance - member.force) +
                              member.base_stiffness * change[member.place];
    }
    for (const SlipMember& pair : problem_->slipping) {
        const Vector2d way = change(pair.place), x = problem_->now(pair.place) + way;
        force(pair.place) =
            (project_on_disc(-x / pair.compliance, pair.budget) - pair.force) + pair.base_stiffness * way;
    }
    return force;
}

void MemberNewton::enter_slopes(const VectorXd& change)
{
    const VectorXd displacement = problem_->now + change;
    const Eigen::Index size = force_.size();
    slopes_ = MatrixXd::Zero(size, 2);
    partner_.resize(static_cast<std::size_t>(size));
    std::iota(partner_.begin(), partner_.end(), 0);
    differing_.clear();
    const auto enter = [&](int place, double slope) {
        slopes_(place, 0) = slope;
        if (std::abs(slope) > 0.0) differing_.push_back(place);
    };
    for (const BoundMember& member : problem_->bounds) {
        const double compliance = compliance_of(member);
        enter(member.place,
              member.force - displacement[member.place] / compliance > 0.0 ? 1.0 / compliance : 0.0);
    }
    for (const RowMember& member : problem_->rows)
        enter(member.place,
              (displacement[member.place] < 0.0 ? 1.0 / member.compliance : 0.0) - member.base_stiffness);
    for (const SlipMember& pair : problem_->slipping) {
        const Vector2d x = displacement(pair.place);
        const Matrix2d slope =
            slip_stiffness(-x / pair.compliance, pair.impulse, pair.budget, pair.compliance) -
            pair.base_stiffness;
        if (slope.isZero(0.0)) continue;
        for (const int d : {0, 1}) {
            partner_[pair.place[d]] = pair.place[1 - d];
            slopes_(pair.place[d], 0) = slope(d, d);
            slopes_(pair.place[d], 1) = slope(d, 1 - d);
            differing_.push_back(pair.place[d]);
        }
    }
    std::sort(differing_.begin(), differing_.end());
}

VectorXd MemberNewton::slopes_times(const VectorXd& way) const
{
    VectorXd product = VectorXd::Zero(way.size());
    for (const int a : differing_) product[a] = slopes_(a, 0) * way[a] + slopes_(a, 1) * way[partner_[a]];
    return product;
}

/// (1 + D S) dz = psi - z with D = `slopes_`; where D is 0, dz is known. False where the matrix is singular.
bool MemberNewton::take_step(bool does_search)
{
    const MatrixXd& S = problem_->mobility;
    const auto count = static_cast<Eigen::Index>(differing_.size());
    const double n = static_cast<double>(force_.size()), k = static_cast<double>(count);
    if (!budget_->spend(2.0 / 3.0 * k * k * k + 4.0 * n * n)) return false;
    VectorXd step = error_;
    for (const int a : differing_) step[a] = 0.0;
    const VectorXd moved = S * step;
    MatrixXd matrix(count, count);
    VectorXd rhs(count);
    for_each_in_batches(static_cast<int>(count), [&](int i) {
        const int a = differing_[i], b = partner_[a];
        const double own = slopes_(a, 0), other = slopes_(a, 1);
        rhs[i] = error_[a] - own * moved[a] - other * moved[b];
        for (Eigen::Index j = 0; j < count; ++j)  // S is symmetric: its columns are contiguous
            matrix(i, j) = own * S(differing_[j], a) + other * S(differing_[j], b);
        matrix(i, i) += 1.0;
        // Rows of stiff springs are far larger than others: scaled for the choice of pivots.
        const double scale = 1.0 / matrix.row(i).lpNorm<Eigen::Infinity>();
        matrix.row(i) *= scale;
        rhs[i] *= scale;
    });
    if (count > 0) step(differing_) = solve_dense(std::move(matrix), rhs).col(0);
    if (!step.allFinite()) return false;
    const VectorXd way = S * step;

    double share = 1.0;
    if (does_search) {
        const double at_start = way.dot(force_), growth = way.dot(step);
        share = search_share(
            [&](double t) { return at_start + t * growth - way.dot(law_at(change_ + t * way)); });
    }
    for (SlipMember& pair : problem_->slipping) {
        const Vector2d moved_by = change_(pair.place) + way(pair.place);
        pair.impulse = force_(pair.place) + step(pair.place) + pair.force - pair.base_stiffness * moved_by;
    }
    force_ += share * step;
    change_ += share * way;
    return true;
}

std::optional<VectorXd> MemberNewton::run(double tolerance)
{
    constexpr int kMostSteps = 100;
    constexpr int kPatience = 2;         // full steps without gain before the search begins
    constexpr double kGain = 0.9;        // a smaller error is a gain
    constexpr double kRoundOff = 1e-14;  // of the largest force
    // The first step is linear around the displacements now: the response without the members goes far from
    // there.
    force_ = VectorXd::Zero(problem_->offset.size());
    change_ = problem_->offset;
    const VectorXd none = VectorXd::Zero(change_.size());
    enter_slopes(none);
    error_ = law_at(none) - slopes_times(change_);
    if (!take_step(false)) return std::nullopt;
    VectorXd best_force = force_, best_change = change_;
    double best = std::numeric_limits<double>::infinity();
    int without_gain = 0;
    bool does_search = false;
    for (int step = 0; step < kMostSteps; ++step) {
        error_ = law_at(change_) - force_;
        const double error = error_.lpNorm<Eigen::Infinity>();
        const double round_off = kRoundOff * force_.lpNorm<Eigen::Infinity>();
        if (error <= std::max(tolerance, round_off)) return force_;
        if (error < kGain * best) {
            best = error;
            best_force = force_;
            best_change = change_;
            without_gain = 0;
        } else if (!does_search && ++without_gain > kPatience) {
            does_search = true;
            force_ = best_force;
            change_ = best_change;
            error_ = law_at(change_) - force_;
        }
        enter_slopes(change_);
        if (!take_step(does_search)) return std::nullopt;
    }
    return force_;
}

}  // namespace

std::optional<VectorXd> solve_members(MemberProblem& problem, double tolerance, DenseBudget& budget,
                                      int& nlopt_evaluations)
{
    if (!problem.mobility.allFinite() || !problem.offset.allFinite()) return std::nullopt;
    if (problem.slipping.empty()) return push_by_nlopt(problem, budget, nlopt_evaluations);
    return MemberNewton(problem, budget).run(tolerance);
}

}  // namespace arris
