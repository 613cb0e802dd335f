// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "physics/elements/term.h"

namespace arris {

/// Consistent inertia of linear triangles: m_ij = rho A / 12 (1 + delta_ij) between the corners' material
/// velocities. Corner matrices then reduce it to the coordinates of EOL vertices.
class Inertia : public FaceTerm {
  public:
    explicit Inertia(const Materials& materials) : materials_(materials) {}
    void add(const FaceState& face, FaceSystem& system) const override;

  private:
    Materials materials_;
};

/// Kinetic energy, J, of a cloth whose vertices move with `velocity` (m/s, one entry per vertex).
double kinetic_energy(const Materials& materials, const ClothElements& elements,
                      const std::vector<Vec3>& velocity);

/// Linear momentum, kg m/s.
Vec3 linear_momentum(const Materials& materials, const ClothElements& elements,
                     const std::vector<Vec3>& velocity);

/// Angular momentum about the origin, kg m^2/s.
Vec3 angular_momentum(const Materials& materials, const ClothElements& elements,
                      const std::vector<Vec3>& position, const std::vector<Vec3>& velocity);

/// Velocity of the material at the corners of each face, m/s.
using CornerVelocities = std::vector<std::array<Vec3, 3>>;

/// Corner velocities w = v - F V of a cloth through whose vertices material flows with `material_velocity`
/// (m/s, one entry per vertex, 0 where none flows). `elements` are those of the present material coordinates.
CornerVelocities compute_corner_velocities(const ClothElements& elements, const std::vector<Vec3>& position,
                                           const std::vector<Vec3>& velocity,
                                           const std::vector<Vec2>& material_velocity);

/// Energy and momenta from corner velocities. Without flow they are bitwise those from the vertices'
/// velocities.
double kinetic_energy(const Materials& materials, const ClothElements& elements,
                      const CornerVelocities& velocity);
Vec3 linear_momentum(const Materials& materials, const ClothElements& elements,
                     const CornerVelocities& velocity);
Vec3 angular_momentum(const Materials& materials, const ClothElements& elements,
                      const std::vector<Vec3>& position, const CornerVelocities& velocity);

/// One velocity of the material per vertex, m/s. Where material flows (`material_velocity` is not zero) this
/// is the area-weighted mean over the vertex's corners, as the two sides of a fold differ. Elsewhere it is
/// the vertex's own velocity.
std::vector<Vec3> mean_corner_velocities(const ClothElements& elements, const CornerVelocities& corners,
                                         const std::vector<Vec3>& velocity,
                                         const std::vector<Vec2>& material_velocity);

}  // namespace arris
