// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/kkt_certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/symmetric_product.h"

namespace arris {
namespace {

/// The larger one; unlike std::max it lets no NaN pass unseen.
double worse(double a, double b)
{
    return std::isnan(a) || a >= b ? a : b;
}

/// error / scale for error >= 0, where no error needs no scale.
double relative(double error, double scale)
{
    return error <= 0.0 ? 0.0 : error / scale;
}

double largest(const Eigen::VectorXd& values)
{
    double result = 0.0;
    for (const double value : values) result = worse(result, std::abs(value));
    return result;
}

double stationarity(const VelocityProblem& problem, const Eigen::VectorXd& velocity,
                    const Eigen::VectorXd& multipliers)
{
    const SymmetricProduct product = symmetric_product_with_magnitude(*problem.matrix, velocity);
    const Eigen::VectorXd& rhs = *problem.rhs;
    double result = 0.0;
    for (int i = 0; i < velocity.size(); ++i) {
        if (problem.is_fixed[i]) continue;
        const double error = std::abs(product.value[i] - rhs[i] - multipliers[i]);
        const double scale = product.magnitude[i] + std::abs(rhs[i]) + std::abs(multipliers[i]);
        result = worse(result, relative(error, scale));
    }
    return result;
}

}  // namespace

double kkt_residual(const VelocityProblem& problem, const Eigen::VectorXd& velocity,
                    const Eigen::VectorXd& multipliers)
{
    const double speed = largest(velocity), impulse = largest(multipliers);
    double result = worse(stationarity(problem, velocity, multipliers),
                          std::isnan(speed + impulse) ? speed + impulse : 0.0);
    for (int i = 0; i < velocity.size(); ++i) {
        if (problem.is_fixed[i]) {
            result = worse(result, relative(std::abs(velocity[i]), speed));
            continue;
        }
        const double gap = velocity[i] - problem.lower[i];
        result = worse(result, relative(-gap, speed));
        result = worse(result, relative(-multipliers[i], impulse));
        const double force = std::abs(multipliers[i]);
        // (lambda / max|lambda|) (gap / max|u|): neither product can overflow.
        if (!(force <= 0.0))
            result = worse(result, relative(force, impulse) * relative(std::abs(gap), speed));
    }
    return result;
}

}  // namespace arris
