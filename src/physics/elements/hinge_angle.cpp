// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/hinge_angle.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace arris {

std::optional<HingeAngle> find_hinge_angle(const std::array<Vec3, 4>& x)
{
    const Vec3 e = x[1] - x[0], to_c = x[2] - x[0], to_d = x[3] - x[0];
    HingeAngle angle;
    angle.normal_c = e.cross(to_c);
    angle.normal_d = to_d.cross(e);
    angle.length_c = angle.normal_c.norm();
    angle.length_d = angle.normal_d.norm();

    constexpr double kCollapsed = 1e-12;  // relative to the squared size: below, the normal's direction is
                                          // rounding
    const double squared_size = e.squaredNorm() + to_c.squaredNorm() + to_d.squaredNorm();
    if (!(angle.length_c > kCollapsed * squared_size && angle.length_d > kCollapsed * squared_size))
        return std::nullopt;
    // grad theta grows as one over the altitude. Below this ratio the true stiffness would dominate the mass.
    // So it is held constant there, and the force fades to zero as the face collapses. One factor for all
    // corners avoids a net torque.
    constexpr double kThin = 1e-4;
    angle.softening =
        std::min({1.0, angle.length_c / (kThin * squared_size), angle.length_d / (kThin * squared_size)});
    angle.normal_c /= angle.length_c;
    angle.normal_d /= angle.length_d;
    return angle;
}

double sine_of_angle(const HingeAngle& angle, const std::array<Vec3, 4>& x)
{
    const Vec3 e = x[1] - x[0];
    return angle.normal_c.cross(angle.normal_d).dot(e) / e.norm();
}

std::array<Vec3, 4> angle_gradient(const HingeAngle& angle, const std::array<Vec3, 4>& x)
{
    // The gradient at c and d follows from the altitudes, at a and b from the lever rule.
    const Vec3 e = x[1] - x[0];
    const double length = e.norm();
    const double at_c = (x[2] - x[0]).dot(e) / (length * length);
    const double at_d = (x[3] - x[0]).dot(e) / (length * length);
    std::array<Vec3, 4> gradient;
    gradient[2] = -length / angle.length_c * angle.normal_c;
    gradient[3] = -length / angle.length_d * angle.normal_d;
    gradient[2] *= angle.softening;
    gradient[3] *= angle.softening;
    gradient[0] = -(1.0 - at_c) * gradient[2] - (1.0 - at_d) * gradient[3];
    gradient[1] = -at_c * gradient[2] - at_d * gradient[3];
    return gradient;
}

}  // namespace arris
