// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/hinge_fold.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace arris {

std::optional<HingeFold> find_fold(const std::array<Vec3, 4>& x)
{
    const Vec3 e = x[1] - x[0], to_c = x[2] - x[0], to_d = x[3] - x[0];
    HingeFold fold;
    fold.normal_c = e.cross(to_c);
    fold.normal_d = to_d.cross(e);
    fold.length_c = fold.normal_c.norm();
    fold.length_d = fold.normal_d.norm();

    constexpr double kCollapsed = 1e-12;  // relative to the squared size: below, the normal's direction is
                                          // rounding
    const double squared_size = e.squaredNorm() + to_c.squaredNorm() + to_d.squaredNorm();
    if (!(fold.length_c > kCollapsed * squared_size && fold.length_d > kCollapsed * squared_size))
        return std::nullopt;
    // grad theta grows as one over the altitude. Below this ratio the true stiffness would dominate the mass.
    // So it is held constant there, and the force fades to zero as the face collapses. One factor for all
    // corners avoids a net torque.
    constexpr double kThin = 1e-4;
    fold.softening =
        std::min({1.0, fold.length_c / (kThin * squared_size), fold.length_d / (kThin * squared_size)});
    fold.normal_c /= fold.length_c;
    fold.normal_d /= fold.length_d;
    return fold;
}

double sine_of_angle(const HingeFold& fold, const std::array<Vec3, 4>& x)
{
    const Vec3 e = x[1] - x[0];
    return fold.normal_c.cross(fold.normal_d).dot(e) / e.norm();
}

std::array<Vec3, 4> angle_gradient(const HingeFold& fold, const std::array<Vec3, 4>& x)
{
    // The gradient at c and d follows from the altitudes, at a and b from the lever rule.
    const Vec3 e = x[1] - x[0];
    const double length = e.norm();
    const double at_c = (x[2] - x[0]).dot(e) / (length * length);
    const double at_d = (x[3] - x[0]).dot(e) / (length * length);
    std::array<Vec3, 4> gradient;
    gradient[2] = -length / fold.length_c * fold.normal_c;
    gradient[3] = -length / fold.length_d * fold.normal_d;
    gradient[2] *= fold.softening;
    gradient[3] *= fold.softening;
    gradient[0] = -(1.0 - at_c) * gradient[2] - (1.0 - at_d) * gradient[3];
    gradient[1] = -at_c * gradient[2] - at_d * gradient[3];
    return gradient;
}

}  // namespace arris
