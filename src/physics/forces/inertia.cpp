// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/inertia.h"

#include <Eigen/Geometry>

#include "geometry/batches.h"

namespace arris {

void Inertia::add(const FaceState& face, FaceSystem& system) const
{
    const double m = materials_[face.element.piece].density * face.element.area / 12.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) system.add_mass(i, j, i == j ? 2.0 * m : m);
}

namespace {

/// The sums below take the velocity of a face's corner from velocity_of(f, i).
template <typename VelocityOf>
double sum_kinetic_energy(const Materials& materials, const ClothElements& elements,
                          const VelocityOf& velocity_of)
{
    return sum_in_batches<double>(
        static_cast<int>(elements.faces.size()),
        [&](int first, int last) {
            double energy = 0.0;
            for (int f = first; f < last; ++f) {
                // 1/2 sum m_ij v_i . v_j = rho A / 24 (sum |v_i|^2 + |sum v_i|^2)
                const Vec3& a = velocity_of(f, 0);
                const Vec3& b = velocity_of(f, 1);
                const Vec3& c = velocity_of(f, 2);
                energy += materials[elements.faces[f].piece].density * elements.faces[f].area / 24.0 *
                          (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + (a + b + c).squaredNorm());
            }
            return energy;
        },
        kCheapBatch);
}

template <typename VelocityOf>
Vec3 sum_linear_momentum(const Materials& materials, const ClothElements& elements,
                         const VelocityOf& velocity_of)
{
    Vec3 momentum = Vec3::Zero();
    for (std::size_t f = 0; f < elements.faces.size(); ++f)
        for (int i = 0; i < 3; ++i)
            momentum +=
                materials[elements.faces[f].piece].density * elements.faces[f].area / 3.0 * velocity_of(f, i);
    return momentum;
}

template <typename VelocityOf>
Vec3 sum_angular_momentum(const Materials& materials, const ClothElements& elements,
                          const std::vector<Vec3>& position, const VelocityOf& velocity_of)
{
    Vec3 momentum = Vec3::Zero();
    for (std::size_t f = 0; f < elements.faces.size(); ++f) {
        // sum m_ij x_i x v_j = rho A / 12 (sum x_i x v_i + (sum x_i) x (sum v_j))
        const FaceElement& face = elements.faces[f];
        Vec3 x_sum = Vec3::Zero(), v_sum = Vec3::Zero(), own = Vec3::Zero();
        for (int i = 0; i < 3; ++i) {
            const Vec3& x = position[face.vertices[i]];
            const Vec3& v = velocity_of(f, i);
            x_sum += x;
            v_sum += v;
            own += x.cross(v);
        }
        momentum += materials[face.piece].density * face.area / 12.0 * (own + x_sum.cross(v_sum));
    }
    return momentum;
}

auto at_vertices(const ClothElements& elements, const std::vector<Vec3>& velocity)
{
    return [&](std::size_t f, int i) -> const Vec3& { return velocity[elements.faces[f].vertices[i]]; };
}

auto at_corners(const CornerVelocities& velocity)
{
    return [&](std::size_t f, int i) -> const Vec3& { return velocity[f][i]; };
}

}  // namespace

double kinetic_energy(const Materials& materials, const ClothElements& elements,
                      const std::vector<Vec3>& velocity)
{
    return sum_kinetic_energy(materials, elements, at_vertices(elements, velocity));
}

double kinetic_energy(const Materials& materials, const ClothElements& elements,
                      const CornerVelocities& velocity)
{
    return sum_kinetic_energy(materials, elements, at_corners(velocity));
}

Vec3 linear_momentum(const Materials& materials, const ClothElements& elements,
                     const std::vector<Vec3>& velocity)
{
    return sum_linear_momentum(materials, elements, at_vertices(elements, velocity));
}

Vec3 linear_momentum(const Materials& materials, const ClothElements& elements,
                     const CornerVelocities& velocity)
{
    return sum_linear_momentum(materials, elements, at_corners(velocity));
}

Vec3 angular_momentum(const Materials& materials, const ClothElements& elements,
                      const std::vector<Vec3>& position, const std::vector<Vec3>& velocity)
{
    return sum_angular_momentum(materials, elements, position, at_vertices(elements, velocity));
}

Vec3 angular_momentum(const Materials& materials, const ClothElements& elements,
                      const std::vector<Vec3>& position, const CornerVelocities& velocity)
{
    return sum_angular_momentum(materials, elements, position, at_corners(velocity));
}

CornerVelocities compute_corner_velocities(const ClothElements& elements, const std::vector<Vec3>& position,
                                           const std::vector<Vec3>& velocity,
                                           const std::vector<Vec2>& material_velocity)
{
    CornerVelocities corners(elements.faces.size());
    for_each_in_batches(
        static_cast<int>(corners.size()),
        [&](int f) {
            const FaceState face(elements.faces[f], position);
            for (int i = 0; i < 3; ++i) {
                const int v = face.element.vertices[i], p = face.element.points[i];
                corners[f][i] = velocity[v] - face.F * material_velocity[p];
            }
        },
        kCheapBatch);
    return corners;
}

std::vector<Vec3> mean_corner_velocities(const ClothElements& elements, const CornerVelocities& corners,
                                         const std::vector<Vec3>& velocity,
                                         const std::vector<Vec2>& material_velocity)
{
    std::vector<Vec3> sum(velocity.size(), Vec3::Zero());
    std::vector<double> area(velocity.size(), 0.0);
    for (std::size_t f = 0; f < corners.size(); ++f)
        for (int i = 0; i < 3; ++i) {
            const FaceElement& face = elements.faces[f];
            sum[face.vertices[i]] += face.area * corners[f][i];
            area[face.vertices[i]] += face.area;
        }
    std::vector<Vec3> mean = velocity;
    for (std::size_t v = 0; v < mean.size(); ++v)
        if (!material_velocity[v].isZero(0.0)) mean[v] = sum[v] / area[v];
    return mean;
}

}  // namespace arris
