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
    double length_c, length_d;  ///< of the unnormalised ones: twice the areas
    double softening;           ///< 1, less where a face is all but collapsed
};

std::optional<Normals> find_normals(const std::array<Vec3, 4>& x)
{
    const Vec3 e = x[1] - x[0], to_c = x[2] - x[0], to_d = x[3] - x[0];
    Normals n;
    n.c = e.cross(to_c);
    n.d = to_d.cross(e);
    n.length_c = n.c.norm();
    n.length_d = n.d.norm();

    constexpr double kCollapsed = 1e-12;  // of the squared size: the normal's direction is round-off below
    const double squared_size = e.squaredNorm() + to_c.squaredNorm() + to_d.squaredNorm();
    if (!(n.length_c > kCollapsed * squared_size && n.length_d > kCollapsed * squared_size))
        return std::nullopt;
    // grad theta grows as one over the altitude. Below this the true stiffness would drown the mass; ours
    // stays, and the force fades to none where the face has collapsed. One factor for all corners, so that no
    // torque is made.
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
    // theta = 60 degrees: an edge's right angle within one cell is beyond it, shared by three it is not.
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

    // grad theta: across the edge by the altitudes, on the edge by the lever rule.
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

    // dV/dtheta = K w sin(theta/2) cos(theta/2) = K w sin(theta) / 2;  2 K w (cos(theta/2) / 2)^2 for the
    // stiffness. Of a crease both by its slope, the part with its curvature, which is negative, left out.
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
