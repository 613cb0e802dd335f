// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "solver/velocity_solve/tree_walk.h"

namespace arris {

/// Where the update matrices of a multifrontal factorisation stand in one workspace. Two of them share space
/// only where, in any order in which `TreeWalk::up` may visit, one is no longer needed when the other begins:
/// an update is needed from its own visit to that of its parent.
struct UpdatePlaces {
    std::vector<std::size_t> first;  ///< entry of each supernode's update
    std::size_t size = 0;            ///< of the workspace, in entries

    UpdatePlaces() = default;
    UpdatePlaces(const EliminationTree& tree, const TreeWalk& walk);
};

}  // namespace arris
