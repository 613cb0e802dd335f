// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solver/dense_reference.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/solver/cloth_system.h"

namespace arris::testing {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

Vector solve_on(const Matrix& a, const Vector& c, const std::vector<int>& set)
{
    Vector x = Vector::Zero(c.size());
    if (!set.empty()) {
        const Matrix part = a(set, set);
        const Vector rhs = c(set);
        const Eigen::LLT<Matrix> cholesky(part);
        Vector y = cholesky.solve(rhs);
        y += cholesky.solve(rhs - part * y);
        x(set) = y;
    }
    return x;
}

}  // namespace

DenseAnswer solve_densely(const VelocityProblem& problem)
{
    const Matrix a = dense_symmetric(*problem.matrix).cast<Real>();
    const int size = static_cast<int>(a.rows());
    std::vector<char> is_free(static_cast<std::size_t>(size), 0);
    Vector shift = Vector::Zero(size);  // x = u - shift, x >= 0 where bounded
    for (int i = 0; i < size; ++i) {
        if (problem.is_fixed[i]) continue;
        is_free[i] = std::isinf(problem.lower[i]);
        if (!is_free[i]) shift[i] = problem.lower[i];
    }
    const std::vector<char> is_unbounded = is_free;
    const Vector c = problem.rhs->cast<Real>() - a * shift;
    const auto set = [&] {
        std::vector<int> result;
        for (int i = 0; i < size; ++i)
            if (is_free[i]) result.push_back(i);
        return result;
    };
    Vector x = solve_on(a, c, set());
    const Real tiny = 1e-17L;
    for (;;) {
        const Vector descent = c - a * x;
        const Vector scale = c.cwiseAbs() + a.cwiseAbs() * x.cwiseAbs();
        int best = -1;
        for (int i = 0; i < size; ++i) {
            if (is_free[i] || problem.is_fixed[i] || descent[i] <= tiny * scale[i]) continue;
            const auto gain = [&](int k) { return descent[k] * descent[k] / a(k, k); };
            if (best < 0 || gain(i) > gain(best)) best = i;
        }
        if (best < 0) break;
        is_free[best] = 1;
        for (;;) {
            const Vector target = solve_on(a, c, set());
            Real step = 1;
            for (int i = 0; i < size; ++i)
                if (is_free[i] && !is_unbounded[i] && target[i] < 0)
                    step = std::min(step, x[i] / (x[i] - target[i]));
            const bool is_blocked = step < 1;
            if (!is_blocked) {
                x = target;
                break;
            }
            for (int i = 0; i < size; ++i) {
                if (!is_free[i] || is_unbounded[i]) continue;
                const bool blocks = target[i] < 0 && x[i] <= step * (x[i] - target[i]);
                if (!blocks) continue;
                is_free[i] = 0;
            }
            x += step * (target - x);
            for (int i = 0; i < size; ++i)
                if (!is_free[i]) x[i] = 0;
        }
    }
    Vector multipliers = a * x - c;
    for (int i = 0; i < size; ++i)
        if (is_free[i] || problem.is_fixed[i]) multipliers[i] = 0;
    return {(x + shift).cast<double>(), multipliers.cast<double>()};
}

double dense_kkt_residual(const VelocityProblem& problem, const VelocitySolution& solution)
{
    const Matrix a = dense_symmetric(*problem.matrix).cast<Real>();
    const Vector u = solution.velocity.cast<Real>(), force = solution.multipliers.cast<Real>(),
                 b = problem.rhs->cast<Real>();
    const Vector error = (a * u - b - force).cwiseAbs();
    const Vector scale = a.cwiseAbs() * u.cwiseAbs() + b.cwiseAbs() + force.cwiseAbs();
    const Real speed = u.cwiseAbs().maxCoeff(), impulse = force.cwiseAbs().maxCoeff();
    Real worst = 0;
    const auto count = [&](Real value, Real by) {
        if (value > 0) worst = std::max(worst, value / by);
    };
    for (int i = 0; i < u.size(); ++i) {
        if (problem.is_fixed[i]) {
            count(std::abs(u[i]), speed);
            continue;
        }
        count(error[i], scale[i]);
        count(problem.lower[i] - u[i], speed);
        count(-force[i], impulse);
        if (std::abs(force[i]) > 0) count(std::abs(force[i] * (u[i] - problem.lower[i])), impulse * speed);
    }
    return static_cast<double>(worst);
}

}  // namespace arris::testing
