// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/condensed_discs.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arris {
namespace {

/// Residual of z = P(z - w), relative to the largest |z| or |q|, at which an answer is accepted: at once, and
/// where Newton's method makes no more progress.
constexpr double kExact = 1e-14;
constexpr double kAcceptable = 1e-11;

/// Sweeps of block descent: before Newton's method, after each of its steps that did not help, and in all.
constexpr int kFirstSweeps = 10;
constexpr int kMoreSweeps = 40;
constexpr int kMostSweeps = 2000;
constexpr int kNewtonSteps = 60;

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

    /// Newton's step for y = P(y - w); nothing where its matrix is singular.
    std::optional<Eigen::VectorXd> newton(const Eigen::VectorXd& y, const Eigen::VectorXd& w) const
    {
        // With D the slope of P: (I - D (I - S)) step = P(y - w) - y. Unknowns whose D is 0 go straight to
        // their bound.
        const Eigen::VectorXd v = y - w, rhs = project(v) - y;
        std::vector<int> free;
        for (int i = 0; i < size(); ++i)
            if (is_in_disc[i] || v[i] > 0.0) free.push_back(i);
        Eigen::MatrixXd matrix = S(free, free);
        Eigen::VectorXd right = rhs(free), step = rhs;
        step(free).setZero();
        const Eigen::VectorXd pulled = S * step;  // change of w by the steps of the others
        std::vector<int> place(static_cast<std::size_t>(size()), -1);
        for (std::size_t k = 0; k < free.size(); ++k) place[free[k]] = static_cast<int>(k);
        for (const int i : free)
            if (!is_in_disc[i]) right[place[i]] -= pulled[i];
        for (const CondensedDisc& disc : discs) {
            const int a = place[disc.first], b = place[disc.second];
            const Eigen::Matrix2d slope = projection_slope(get(disc, v), disc.radius);
            Eigen::MatrixXd rows(2, matrix.cols());
            rows << matrix.row(a), matrix.row(b);
            rows = (slope * rows).eval();
            const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - slope;
            for (int c = 0; c < 2; ++c) {
                rows(c, a) += rest(c, 0);
                rows(c, b) += rest(c, 1);
            }
            matrix.row(a) = rows.row(0);
            matrix.row(b) = rows.row(1);
            const Eigen::Vector2d shift = slope * get(disc, pulled);
            right[a] -= shift[0];
            right[b] -= shift[1];
        }
        const Eigen::VectorXd found = matrix.partialPivLu().solve(right);
        if (!found.allFinite()) return std::nullopt;
        step(free) = found;
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
        measure(problem);
    }
    void measure(const DiscProblem& problem)
    {
        residual = (problem.project(y - w) - y).lpNorm<Eigen::Infinity>();
    }
};

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
    const double n = static_cast<double>(problem.size());
    Trial best(problem, problem.project(start.cwiseQuotient(problem.scale)));
    const double unit = problem.q.lpNorm<Eigen::Infinity>();
    const auto is_within = [&](double tolerance) {
        return best.residual <= tolerance * std::max(unit, best.y.lpNorm<Eigen::Infinity>());
    };
    int sweeps = 0;
    const auto descend = [&](int count) {
        for (int k = 0; k < count && sweeps < kMostSweeps && !is_within(kExact); ++k, ++sweeps) {
            if (!budget.spend(4.0 * n * n)) return false;
            problem.descend(best.y, best.w);
            best.measure(problem);
        }
        best = Trial(problem, std::move(best.y));
        return true;
    };
    if (!descend(kFirstSweeps)) return std::nullopt;
    for (int step = 0; step < kNewtonSteps && !is_within(kExact); ++step) {
        if (!budget.spend(n * n * n)) return std::nullopt;
        const std::optional<Eigen::VectorXd> change = problem.newton(best.y, best.w);
        if (change) {
            Trial trial(problem, best.y + *change);
            if (trial.residual < 0.5 * best.residual) {
                best = std::move(trial);
                continue;
            }
        }
        if (is_within(kAcceptable) || sweeps >= kMostSweeps) break;
        if (!descend(kMoreSweeps)) return std::nullopt;
    }
    if (!is_within(kAcceptable)) return std::nullopt;

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
