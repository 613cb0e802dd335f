// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/velocity_solve/working_set.h"

namespace arris {

/// What a working set has to take in.
struct Violators {
    std::vector<int> coordinates;  ///< free and below their bound, or active and pulling; ascending
    std::vector<int> rows;         ///< of each group the one that is violated worst
    bool empty() const { return coordinates.empty() && rows.empty(); }
};

/// The violators outside `set`. NaN counts as a violation. A row's violation counts as far as it is greater
/// than those of the rows that `set` is to meet: less is the same round-off.
Violators find_violators(const PinnedBase& base, const Iterate& iterate, const WorkingSet& set);

/// Keeps the `count` coordinates whose correction alone would change the energy most: lambda^2 / A_ii or
/// A_ii gap^2.
void keep_worst_coordinates(const PinnedBase& base, const Iterate& iterate, int count,
                            std::vector<int>& coordinates);

/// The same for rows: gap^2 / (g^T D^-1 g).
void keep_worst_rows(const PinnedBase& base, const Iterate& iterate, int count, std::vector<int>& rows);

}  // namespace arris
