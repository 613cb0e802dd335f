// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/elements/term.h"

namespace arris {

/// Drag of the air on each face: f = rho/2 drag A |w_n| w_n n. A and n are the face's world area and normal,
/// w_n = n . w, and w is the wind less the material's velocity at the face's middle. Linearised in the
/// velocity: -df/dv = rho drag A |w_n| n n^T, which damps. The change of f as the face turns is not
/// linearised; the next step includes it.
class WindForce : public FaceTerm {
  public:
    explicit WindForce(const Wind& wind);
    bool is_drive() const override { return true; }
    void add(const FaceState& face, FaceSystem& system) const override;

    /// Velocity of the air at `time` (s), m/s, including the gust.
    Vec3 velocity_at(double time) const;

  private:
    Wind wind_;
    double gust_phase_ = 0.0;  ///< radians
};

}  // namespace arris
