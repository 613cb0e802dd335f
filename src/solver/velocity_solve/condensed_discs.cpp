// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/condensed_discs.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/velocity_solve/dense_solve.h"

namespace arris {
namespace {

/// Residual of z = P(z - w), relative to the largest |z| or |q|, at which an answer is accepted: at once, and
/// where Newton's method makes no more progress.
constexpr double kExact = 1e-14;
constexpr double kAcceptable = 1e-11;

/// Sweeps of block descent before Newton's method: at first, their growth from round to round, and in all, a
/// multiple of the number of unknowns. Then minimising the energy costs less.
constexpr int kFirstSweeps = 10, kGrowth = 3, kMostSweeps = 2;
constexpr int kMostPolishing = 10;

/// Steps of Newton's method on the energy. Problems of 300 unknowns take up to 50.
constexpr int kMostSteps = 150;

/// The scaled problem: z = scale * y, with a diagonal of S of at most 1. The unknowns of a disc have one
/// scale, so that it stays a disc.
class DiscProblem {
  public:
    explicit DiscProblem(const CondensedQp& qp)
        : scale(qp.hessian.diagonal().array().rsqrt()), discs(qp.discs)
    {
        is_in_disc.assign(static_cast<std::size_t>(qp.linear.size()), 0);
        for (CondensedDisc& disc : discs) {
            const double one = std::min(scale[disc.first], scale[disc.second]);
            scale[disc.first] = scale[disc.second] = one;
            disc.radius /= one;
            is_in_disc[disc.first] = is_in_disc[disc.second] = 1;
        }
        S = scale.asDiagonal() * qp.hessian * scale.asDiagonal();
        q = scale.cwiseProduct(qp.linear);
    }

    int size() const { return static_cast<int>(q.size()); }
    Eigen::VectorXd slack(const Eigen::VectorXd& y) const { return S * y + q; }

    Eigen::VectorXd project(Eigen::VectorXd y) const
    {
        for (int i = 0; i < size(); ++i)
            if (!is_in_disc[i]) y[i] = std::max(y[i], 0.0);
        for (const CondensedDisc& disc : discs) set(disc, project_on_disc(get(disc, y), disc.radius), y);
        return y;
    }

    static Eigen::Vector2d get(const CondensedDisc& disc, const Eigen::VectorXd& y)
    {
        return {y[disc.first], y[disc.second]};
    }
    static void set(const CondensedDisc& disc, const Eigen::Vector2d& value, Eigen::VectorXd& y)
    {
        y[disc.first] = value[0];
        y[disc.second] = value[1];
    }

    /// One sweep of block descent; keeps w = S y + q.
    void descend(Eigen::VectorXd& y, Eigen::VectorXd& w) const
    {
        for (int i = 0; i < size(); ++i) {
            if (is_in_disc[i]) continue;
            const double change = std::max(y[i] - w[i] / S(i, i), 0.0) - y[i];
            y[i] += change;
            if (std::abs(change) > 0.0) w += change * S.col(i);
        }
        for (const auto& disc : discs) {
            const auto [i, j, radius] = disc;
            Eigen::Matrix2d block;
            block << S(i, i), S(i, j), S(j, i), S(j, j);
            const Eigen::Vector2d old = get(disc, y);
            const Eigen::Vector2d change = minimise_in_disc(block, get(disc, w) - block * old, radius) - old;
            set(disc, old + change, y);
            if (change.squaredNorm() > 0.0) w += change[0] * S.col(i) + change[1] * S.col(j);
        }
    }

    /// Newton's step for y = P(v) with v = y - (S y + q) / give: with D the slope of P at v it solves
    /// ((1 - D) + D S / give) step = P(v) - y. Nothing where its matrix is singular.
    std::optional<Eigen::VectorXd> newton(const Eigen::VectorXd& y, const Eigen::VectorXd& v,
                                          double give) const
    {
        const Eigen::VectorXd rhs = project(v) - y;
        std::vector<int> free;  // the others, with D = 0, go straight to their bound
        for (int i = 0; i < size(); ++i)
            if (is_in_disc[i] || v[i] > 0.0) free.push_back(i);
        Eigen::VectorXd step = rhs;
        for (const int i : free) step[i] = 0.0;
        const Eigen::VectorXd pulled = S * step / give;  // by the steps of the others
        Eigen::MatrixXd matrix = S(free, free);
        Eigen::VectorXd right = (rhs - pulled)(free);
        matrix /= give;
        std::vector<int> place(static_cast<std::size_t>(size()), -1);
        for (std::size_t k = 0; k < free.size(); ++k) place[free[k]] = static_cast<int>(k);
        for (const CondensedDisc& disc : discs) {
            const std::array<int, 2> at = {place[disc.first], place[disc.second]};
            const Eigen::Matrix2d slope = projection_slope(get(disc, v), disc.radius);
            const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - slope;
            const Eigen::Matrix2Xd rows = slope * matrix(at, Eigen::all);
            matrix(at, Eigen::all) = rows;
            matrix(at, at) += rest;
            right(at) = get(disc, rhs) - slope * get(disc, pulled);
        }
        const Eigen::VectorXd found = solve_dense(std::move(matrix), right);
        if (!found.allFinite()) return std::nullopt;
        for (std::size_t k = 0; k < free.size(); ++k) step[free[k]] = found[static_cast<Eigen::Index>(k)];
        return step;
    }

    Eigen::VectorXd scale;
    std::vector<CondensedDisc> discs;
    std::vector<char> is_in_disc;
    Eigen::MatrixXd S;
    Eigen::VectorXd q;
};

/// An iterate with its w and the residual of y = P(y - w).
struct Trial {
    Eigen::VectorXd y, w;
    double residual = 0.0;

    Trial(const DiscProblem& problem, Eigen::VectorXd at) : y(std::move(at)), w(problem.slack(y))
    {
        residual = (problem.project(y - w) - y).lpNorm<Eigen::Infinity>();
    }
    bool is_within(const DiscProblem& problem, double tolerance) const
    {
        return residual <=
               tolerance * std::max(problem.q.lpNorm<Eigen::Infinity>(), y.lpNorm<Eigen::Infinity>());
    }
};

/// Share of a step from x at which the energy of `minimise_energy` is least. `v`: -(M x + q) / give.
double find_share(const DiscProblem& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& step,
                  const Eigen::VectorXd& M_step, const Eigen::VectorXd& v, double give)
{
    constexpr int kBisections = 40;
    const auto slope = [&](double share) {
        return M_step.dot(x + share * step - problem.project(v - share / give * M_step));
    };
    if (!(slope(1.0) > 0.0)) return 1.0;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (low + high);
        (slope(middle) > 0.0 ? high : low) = middle;
    }
    return high;
}

/// False where the budget is spent.
bool descend(const DiscProblem& problem, int sweeps, Trial& best, DenseBudget& budget)
{
    const double n = static_cast<double>(problem.size());
    if (!budget.spend(4.0 * n * n * sweeps)) return false;
    for (int sweep = 0; sweep < sweeps; ++sweep) problem.descend(best.y, best.w);
    best = Trial(problem, std::move(best.y));
    return true;
}

/// Newton's method on y = P(y - w) from near an answer. True where it ends at kAcceptable at least.
bool polish(const DiscProblem& problem, Trial& best, DenseBudget& budget)
{
    const double n = static_cast<double>(problem.size());
    for (int step = 0; step < kMostPolishing && !best.is_within(problem, kExact); ++step) {
        if (!budget.spend(n * n * n)) break;
        const std::optional<Eigen::VectorXd> change = problem.newton(best.y, best.y - best.w, 1.0);
        if (!change) break;
        Trial trial(problem, best.y + *change);
        if (!(trial.residual < 0.5 * best.residual)) break;
        best = std::move(trial);
    }
    return best.is_within(problem, kAcceptable);
}

/// A polished answer. With give below the least eigenvalue of S, M = S - give is positive
/// definite, and each unknown is the force P(-(M x + q) / give) of a spring: min 1/2 x^T M x + the springs'
/// energies, which is convex and smooth, so that Newton's method with an exact line search finds the minimum
/// from any start.
std::optional<Trial> minimise_energy(const DiscProblem& problem, Eigen::VectorXd x, DenseBudget& budget)
{
    constexpr double kBelow = 0.9, kLeastGive = 1e-10;
    constexpr double kNear = 1e-6;  // residual from which polishing is tried: v has lost four digits and more
    const double n = static_cast<double>(problem.size());
    if (!budget.spend(2.0 * n * n * n)) return std::nullopt;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(problem.S, Eigen::EigenvaluesOnly);
    const double give = kBelow * eigen.eigenvalues()[0];
    if (!(give > kLeastGive)) return std::nullopt;
    for (int step = 0; step < kMostSteps; ++step) {
        const Eigen::VectorXd v = x - problem.slack(x) / give;
        Trial trial(problem, problem.project(v));
        if (trial.is_within(problem, kNear) && polish(problem, trial, budget)) return trial;
        if (!budget.spend(n * n * n)) return std::nullopt;
        const std::optional<Eigen::VectorXd> way = problem.newton(x, v, give);
        if (!way) return std::nullopt;
        const Eigen::VectorXd M_way = problem.S * *way - give * *way;
        x += find_share(problem, x, *way, M_way, v, give) * *way;
    }
    return std::nullopt;
}

}  // namespace

Eigen::Vector2d project_on_disc(const Eigen::Vector2d& z, double radius)
{
    const double length = z.norm();
    return length <= radius ? z : Eigen::Vector2d(radius / length * z);
}

Eigen::Matrix2d projection_slope(const Eigen::Vector2d& z, double radius)
{
    const double length = z.norm();
    if (length <= radius) return Eigen::Matrix2d::Identity();
    const Eigen::Vector2d d = z / length;
    return radius / length * (Eigen::Matrix2d::Identity() - d * d.transpose());
}

Eigen::Vector2d minimise_in_disc(const Eigen::Matrix2d& S, const Eigen::Vector2d& q, double radius)
{
    if (!(radius > 0.0)) return Eigen::Vector2d::Zero();
    const Eigen::Vector2d inside = -S.inverse() * q;
    if (inside.norm() <= radius) return inside;
    // On the rim (S + k I) z = -q with |z(k)| = radius. 1 / |z(k)| is concave and nearly linear in k, so
    // Newton's method on 1 / |z| - 1 / radius rises monotonically from k = 0 (More and Sorensen 1983).
    constexpr int kMostSteps = 60;
    constexpr double kAccurate = 1e-15;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(S);
    const Eigen::Vector2d a = eigen.eigenvectors().transpose() * q, e = eigen.eigenvalues();
    Eigen::Vector2d z = Eigen::Vector2d::Zero();
    double k = 0.0;
    for (int step = 0; step < kMostSteps; ++step) {
        z = {a[0] / (e[0] + k), a[1] / (e[1] + k)};
        const double length = z.norm(), excess = length / radius - 1.0;
        if (!(excess > kAccurate)) break;
        const double slope = z[0] * z[0] / (e[0] + k) + z[1] * z[1] / (e[1] + k);  // -|z| d|z| / dk
        k += excess * length * length / slope;
    }
    return -(eigen.eigenvectors() * z) * (radius / z.norm());
}

std::optional<CondensedAnswer> solve_with_discs(const CondensedQp& qp, const Eigen::VectorXd& start,
                                                DenseBudget& budget)
{
    if (!qp.hessian.allFinite() || !qp.linear.allFinite()) return std::nullopt;
    if (!(qp.hessian.diagonal().array() > 0.0).all()) return std::nullopt;
    const DiscProblem problem(qp);
    Trial best(problem, problem.project(start.cwiseQuotient(problem.scale)));
    bool is_solved = false;
    for (int sweeps = kFirstSweeps, all = 0;
         !is_solved && (all == 0 || all + sweeps <= kMostSweeps * problem.size());
         all += sweeps, sweeps *= kGrowth)
        is_solved = descend(problem, sweeps, best, budget) && polish(problem, best, budget);
    if (!is_solved) {
        std::optional<Trial> found = minimise_energy(problem, best.y, budget);
        if (!found) return std::nullopt;
        best = std::move(*found);
    }

    CondensedAnswer answer;
    const Eigen::VectorXd v = best.y - best.w, y = problem.project(v);
    answer.is_positive.assign(static_cast<std::size_t>(problem.size()), 1);
    for (int i = 0; i < problem.size(); ++i) {
        if (problem.is_in_disc[i]) continue;
        answer.is_positive[i] = v[i] > 0.0;
        best.w[i] = answer.is_positive[i] ? 0.0 : std::max(best.w[i], 0.0);
    }
    for (const CondensedDisc& disc : problem.discs)
        if (DiscProblem::get(disc, v).norm() <= disc.radius)
            DiscProblem::set(disc, Eigen::Vector2d::Zero(), best.w);
    answer.z = problem.scale.cwiseProduct(y);
    answer.w = best.w.cwiseQuotient(problem.scale);
    return answer;
}

}  // namespace arris
