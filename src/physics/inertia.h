// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/term.h"

namespace arris {

/// Consistent inertia of linear triangles: m_ij = rho A / 12 (1 + delta_ij) between the corners' material
/// velocities (the report's element matrix, section 2.3, once the corner matrices are applied).
class Inertia : public FaceTerm {
  public:
    explicit Inertia(double density) : density_(density) {}
    void add(const FaceState& face, FaceSystem& system) const override;

  private:
    double density_;  ///< areal, kg/m^2
};

/// Kinetic energy, J, of a cloth whose vertices move with `velocity` (m/s, one a vertex).
double kinetic_energy(double density, const ClothElements& elements, const std::vector<Vec3>& velocity);

/// Linear momentum, kg m/s.
Vec3 linear_momentum(double density, const ClothElements& elements, const std::vector<Vec3>& velocity);

/// Angular momentum about the origin, kg m^2/s.
Vec3 angular_momentum(double density, const ClothElements& elements, const std::vector<Vec3>& position,
                      const std::vector<Vec3>& velocity);

}  // namespace arris
