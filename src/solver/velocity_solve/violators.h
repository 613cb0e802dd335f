// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/velocity_solve/working_set.h"

namespace arris {

/// Constraints that a working set must take in.
struct Violators {
    std::vector<int>
        coordinates;  ///< free and below their bound, or active and pulling (negative multiplier); ascending
    std::vector<int> rows;     ///< the worst violated row of each group
    std::vector<int> pulling;  ///< rows of the base whose springs pull; ascending
    std::vector<int> pairs;    ///< friction pairs that their springs in the base are far from; ascending
    bool empty() const { return coordinates.empty() && rows.empty() && pulling.empty() && pairs.empty(); }
};

/// The violators outside `set`. NaN counts as a violation. A row is a violator only if its violation exceeds
/// the errors of the rows that `set` should meet: a smaller violation is round-off.
Violators find_violators(const PinnedBase& base, const Iterate& iterate, const WorkingSet& set);

/// Keeps the `count` coordinates whose correction alone would change the energy most: lambda^2 / A_ii or
/// A_ii gap^2.
void keep_worst_coordinates(const PinnedBase& base, const Iterate& iterate, int count,
                            std::vector<int>& coordinates);

/// Keeps the `count` rows whose correction alone would change the energy most: gap^2 / (g^T D^-1 g).
void keep_worst_rows(const PinnedBase& base, const Iterate& iterate, int count, std::vector<int>& rows);

}  // namespace arris
