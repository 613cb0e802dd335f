// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/slip_law.h"

namespace arris {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Vector2d project_on_disc(const Vector2d& z, double radius)
{
    const double length = z.norm();
    return length <= radius ? z : Vector2d(radius / length * z);
}

Vector2d unlimited_at(const ConstraintRows& constraints, int pair, const Vector2d& values)
{
    const ScaledRow &first = constraints.rows[2 * pair], &second = constraints.rows[2 * pair + 1];
    return (Vector2d(first.lower, second.lower) - values) / first.compliance;
}

Matrix2d slip_stiffness(const Vector2d& unlimited, const Vector2d& impulse, double budget, double compliance)
{
    if (!(budget > 0.0)) return Matrix2d::Zero();
    const double size = unlimited.norm();
    if (size <= budget) return Matrix2d::Identity() / compliance;
    const Vector2d d = unlimited / size, w = project_on_disc(impulse, budget) / budget;
    return budget / (size * compliance) *
           (Matrix2d::Identity() - 0.5 * (w * d.transpose() + d * w.transpose()));
}

double distance(const Matrix2d& stiffness, const Matrix2d& wanted, double mass)
{
    const double scale = wanted.norm() + mass;
    return scale > 0.0 ? (stiffness - wanted).norm() / scale : 0.0;
}

}  // namespace arris
