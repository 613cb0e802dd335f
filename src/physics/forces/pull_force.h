// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/elements/term.h"

namespace arris {

/// A force spread over a box of material while it acts. It does not depend on the cloth's state, so it has no
/// stiffness.
class PullForce : public LoadTerm {
  public:
    explicit PullForce(const Pull& pull) : pull_(pull) {}
    void add(const ClothMesh& mesh, const Linearization& at, std::vector<Vec3>& force) const override;
    std::vector<CornerLoad> corner_loads(const ClothMesh& mesh, const Linearization& at) const override;

  private:
    Pull pull_;
};

}  // namespace arris
