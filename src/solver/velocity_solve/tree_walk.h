// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "solver/velocity_solve/elimination_tree.h"

namespace arris {

/// Visits the supernodes of an elimination tree by several threads. A subtree of little cost is visited by
/// one thread; every supernode above such subtrees is a task of its own. Which supernodes are visited at the
/// same time depends on the threads, but never two of which one is below the other. Refers to the tree.
class TreeWalk {
  public:
    using Visit = std::function<void(int supernode)>;

    explicit TreeWalk(const EliminationTree& tree);

    /// Children before their parents. `flops` of all visits together: one thread makes them where they are
    /// few.
    void up(double flops, const Visit& visit) const;
    /// Parents before their children.
    void down(double flops, const Visit& visit) const;

    /// Flops of a factorisation's longest chain of tasks, with large fronts in tiles.
    double critical_flops() const;

    /// First supernode of the subtree that one thread visits and to which this one belongs; -1 above the
    /// subtrees.
    int subtree_start(int supernode) const { return start_[supernode]; }

  private:
    const EliminationTree& tree_;
    std::vector<int> start_;                         ///< as `subtree_start`
    std::vector<int> subtrees_;                      ///< their roots, the most expensive first
    std::unique_ptr<std::atomic<int>[]> waits_for_;  ///< children that are not yet visited, of `up`
};

}  // namespace arris
