// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/inertia.h"

#include <Eigen/Geometry>

namespace arris {

void Inertia::add(const FaceState& face, FaceSystem& system) const
{
    const double m = density_ * face.element.area / 12.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) system.add_mass(i, j, i == j ? 2.0 * m : m);
}

double kinetic_energy(double density, const ClothElements& elements, const std::vector<Vec3>& velocity)
{
    double energy = 0.0;
    for (const FaceElement& face : elements.faces) {
        // 1/2 sum m_ij v_i . v_j = rho A / 24 (sum |v_i|^2 + |sum v_i|^2)
        const Vec3& a = velocity[face.vertices[0]];
        const Vec3& b = velocity[face.vertices[1]];
        const Vec3& c = velocity[face.vertices[2]];
        energy += density * face.area / 24.0 *
                  (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + (a + b + c).squaredNorm());
    }
    return energy;
}

Vec3 linear_momentum(double density, const ClothElements& elements, const std::vector<Vec3>& velocity)
{
    Vec3 momentum = Vec3::Zero();
    for (const FaceElement& face : elements.faces)
        for (const int v : face.vertices) momentum += density * face.area / 3.0 * velocity[v];
    return momentum;
}

Vec3 angular_momentum(double density, const ClothElements& elements, const std::vector<Vec3>& position,
                      const std::vector<Vec3>& velocity)
{
    Vec3 momentum = Vec3::Zero();
    for (const FaceElement& face : elements.faces) {
        // sum m_ij x_i x v_j = rho A / 12 (sum x_i x v_i + (sum x_i) x (sum v_j))
        Vec3 x_sum = Vec3::Zero(), v_sum = Vec3::Zero(), own = Vec3::Zero();
        for (const int v : face.vertices) {
            x_sum += position[v];
            v_sum += velocity[v];
            own += position[v].cross(velocity[v]);
        }
        momentum += density * face.area / 12.0 * (own + x_sum.cross(v_sum));
    }
    return momentum;
}

}  // namespace arris
