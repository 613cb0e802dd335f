// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/term.h"

namespace arris {

/// Drag of the air on each face: f = rho/2 drag A |w_n| w_n n, A and n its world area and normal, w_n = n . w
/// and w the wind less the material's velocity, taken at the face's middle. Linear in the velocity to first
/// order: -df/dv = rho drag A |w_n| n n^T, which damps. How f changes as the face turns is left to the next
/// step.
class WindForce : public FaceTerm {
  public:
    explicit WindForce(const Wind& wind);
    bool is_drive() const override { return true; }
    void add(const FaceState& face, FaceSystem& system) const override;

    /// Of the air at `time` (s), m/s, the gust included.
    Vec3 velocity_at(double time) const;

  private:
    Wind wind_;
    double gust_phase_ = 0.0;  ///< radians
};

}  // namespace arris
