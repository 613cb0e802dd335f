// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/bending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace arris {

namespace {

struct Normals {
    Vec3 c, d;                  ///< unit, of faces (a, b, c) and (b, a, d)
    double length_c, length_d;  ///< norms of the unnormalised normals: twice the areas
    double softening;           ///< 1; less where a face has almost collapsed
};

std::optional<Normals> find_normals(const std::array<Vec3, 4>& x)
{
    const Vec3 e = x[1] - x[0], to_c = x[2] - x[0], to_d = x[3] - x[0];
    Normals n;
    n.c = e.cross(to_c);
    n.d = to_d.cross(e);
    n.length_c = n.c.norm();
    n.length_d = n.d.norm();

    constexpr double kCollapsed = 1e-12;  // relative to the squared size: below, the normal's direction is
                                          // rounding
    const double squared_size = e.squaredNorm() + to_c.squaredNorm() + to_d.squaredNorm();
    if (!(n.length_c > kCollapsed * squared_size && n.length_d > kCollapsed * squared_size))
        return std::nullopt;
    // grad theta grows as one over the altitude. Below this ratio the true stiffness would dominate the mass.
    // So it is held constant there, and the force fades to zero as the face collapses. One factor for all
    // corners avoids a net torque.
    constexpr double kThin = 1e-4;
    n.softening = std::min({1.0, n.length_c / (kThin * squared_size), n.length_d / (kThin * squared_size)});
    n.c /= n.length_c;
    n.d /= n.length_d;
    return n;
}

/// sin^2(theta/2) = |n_c - n_d|^2 / 4   no cancellation where it is flat
double squared_sine(const Normals& n)
{
    return 0.25 * (n.c - n.d).squaredNorm();
}

/// V / (K w) of a hinge, and its derivative by sigma = sin^2(theta/2).
struct Fold {
    double energy, slope;
};

Fold find_fold(const HingeElement& hinge, double sigma)
{
    // theta = 60 degrees. A right angle within one cell exceeds this; spread over three cells it does not.
    constexpr double kCreased = 0.25;
    if (!hinge.is_crease()) return {sigma, 1.0};
    if (sigma >= kCreased) return {0.5 * kCreased, 0.0};
    return {sigma * (1.0 - 0.5 * sigma / kCreased), 1.0 - sigma / kCreased};
}

}  // namespace

double Bending::energy(const HingeState& hinge) const
{
    const std::optional<Normals> n = find_normals(hinge.x);
    if (!n) return 0.0;
    return stiffness_ * hinge.element.weight * find_fold(hinge.element, squared_sine(*n)).energy;
}

void Bending::add(const HingeState& hinge, HingeSystem& system) const
{
    const std::optional<Normals> n = find_normals(hinge.x);
    if (!n) return;

    // grad theta at c and d follows from the altitudes, at a and b from the lever rule.
    const Vec3 e = hinge.x[1] - hinge.x[0];
    const double length = e.norm();
    const double at_c = (hinge.x[2] - hinge.x[0]).dot(e) / (length * length);
    const double at_d = (hinge.x[3] - hinge.x[0]).dot(e) / (length * length);
    std::array<Vec3, 4> gradient;
    gradient[2] = -length / n->length_c * n->c;
    gradient[3] = -length / n->length_d * n->d;
    const double softening = n->softening;
    gradient[2] *= softening;
    gradient[3] *= softening;
    gradient[0] = -(1.0 - at_c) * gradient[2] - (1.0 - at_d) * gradient[3];
    gradient[1] = -at_c * gradient[2] - at_d * gradient[3];

    // dV/dtheta = K w sin(theta/2) cos(theta/2) = K w sin(theta) / 2; the stiffness has the factor 2 K w
    // (cos(theta/2) / 2)^2. A crease scales both by its slope. The part with a crease's curvature is negative
    // and left out.
    const Fold fold = find_fold(hinge.element, squared_sine(*n));
    const double scale = stiffness_ * hinge.element.weight * fold.slope;
    const double sin_theta = n->c.cross(n->d).dot(e) / length;
    const double squared_cos_half = 0.25 * (n->c + n->d).squaredNorm();
    for (int i = 0; i < 4; ++i) {
        system.add_elastic_force(i, -0.5 * scale * sin_theta * gradient[i]);
        for (int j = 0; j <= i; ++j)
            system.add_stiffness(i, j,
                                 0.5 * scale * squared_cos_half * gradient[i] * gradient[j].transpose());
    }
    if (!system.is_eulerian()) return;
    for (int i = 0; i < 4; ++i)
        system.add_material_force(i, -stiffness_ * fold.energy * hinge.weight_gradients->at(i));
}

}  // namespace arris
