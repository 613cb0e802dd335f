// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "solver/mesh_change/patch_relaxation.h"

namespace arris {

/// Stores answers of `can_relax_by` for one scene, as surgery proposes refused operations repeatedly. The key
/// holds every input to the bit, so that no answer becomes invalid.
class RelaxationMemo {
  public:
    bool can_relax_by(const Scene& scene, const LoosePatch& patch, double drop);
    int count() const { return static_cast<int>(known_.size()); }  ///< of distinct inputs

  private:
    std::map<std::vector<double>, bool> known_;
};

}  // namespace arris
