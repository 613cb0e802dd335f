// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "solver/mesh_change/patch_relaxation.h"

namespace arris {

/// Remembers answers of `can_relax_by` for one scene: surgery proposes what was refused again and again. An
/// answer is found by all that it is a function of, to the bit, so nothing makes one invalid.
class RelaxationMemo {
  public:
    bool can_relax_by(const Scene& scene, const LoosePatch& patch, double drop);
    int count() const { return static_cast<int>(known_.size()); }  ///< of different questions

  private:
    std::map<std::vector<double>, bool> known_;
};

}  // namespace arris
