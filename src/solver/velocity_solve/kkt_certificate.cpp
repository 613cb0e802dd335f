// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/kkt_certificate.h"

#include <algorithm>
#include <cmath>

#include "solver/velocity_solve/symmetric_product.h"

namespace arris {
namespace {

/// The larger number; unlike std::max this keeps a NaN.
double worse(double a, double b)
{
    return std::isnan(a) || a >= b ? a : b;
}

/// error / scale for error >= 0; 0 where the error is 0, whatever the scale.
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

double stationarity(const VelocityProblem& problem, const ConstraintRows& constraints,
                    const Eigen::VectorXd& velocity, const Eigen::VectorXd& multipliers,
                    const Eigen::VectorXd& row_multipliers)
{
    const Eigen::VectorXd product = symmetric_product(*problem.matrix, velocity),
                          round_off = product_of_magnitudes(*problem.matrix, velocity);
    const Eigen::VectorXd& rhs = *problem.rhs;
    Eigen::VectorXd force = multipliers, magnitude = multipliers.cwiseAbs();
    for (std::size_t k = 0; k < constraints.rows.size(); ++k)
        for (const auto& [coordinate, coefficient] : constraints.rows[k].entries) {
            const double share = coefficient * row_multipliers[static_cast<Eigen::Index>(k)];
            force[coordinate] += share;
            magnitude[coordinate] += std::abs(share);
        }
    if (constraints.least_speed > 0.0) magnitude += constraints.least_speed * problem.matrix->diagonal();
    double result = 0.0;
    for (int i = 0; i < velocity.size(); ++i) {
        if (problem.is_fixed[i]) continue;
        const double error = std::abs(product[i] - rhs[i] - force[i]);
        const double scale = round_off[i] + std::abs(rhs[i]) + magnitude[i];
        result = worse(result, relative(error, scale));
    }
    return result;
}

/// Violation, sign and complementarity of one constraint.
double pair_residual(double gap, double multiplier, double speed, double impulse)
{
    double result = worse(relative(-gap, speed), relative(-multiplier, impulse));
    const double force = std::abs(multiplier);
    // (lambda / max|lambda|) (gap / max|u|): neither product can overflow.
    if (!(force <= 0.0)) result = worse(result, relative(force, impulse) * relative(std::abs(gap), speed));
    return result;
}

}  // namespace

double kkt_residual(const VelocityProblem& problem, const ConstraintRows& constraints,
                    const Eigen::VectorXd& velocity, const Eigen::VectorXd& multipliers,
                    const Eigen::VectorXd& row_multipliers)
{
    const double speed = worse(largest(velocity), constraints.least_speed),
                 impulse = worse(largest(multipliers), largest(row_multipliers));
    double result = worse(stationarity(problem, constraints, velocity, multipliers, row_multipliers),
                          std::isnan(speed + impulse) ? speed + impulse : 0.0);
    for (int i = 0; i < velocity.size(); ++i)
        result = worse(result, problem.is_fixed[i] ? relative(std::abs(velocity[i]), speed)
                                                   : pair_residual(velocity[i] - problem.lower[i],
                                                                   multipliers[i], speed, impulse));
    for (std::size_t k = constraints.slip_count(); k < constraints.rows.size(); ++k) {
        const ScaledRow& row = constraints.rows[k];
        if (row.entries.empty()) continue;
        const double multiplier = row_multipliers[static_cast<Eigen::Index>(k)];
        result = worse(result, pair_residual(gap(row, velocity, multiplier), multiplier, speed, impulse));
    }
    return result;
}

double kkt_residual(const VelocityProblem& problem, const Eigen::VectorXd& velocity,
                    const Eigen::VectorXd& multipliers)
{
    return kkt_residual(problem, {}, velocity, multipliers, {});
}

}  // namespace arris
