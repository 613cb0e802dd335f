// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "solver/velocity_solve/pinned_base.h"
#include "solver/velocity_solve/working_set.h"

namespace arris {

/// A factorised base with its working set and current iterate.
struct BaseInUse {
    PinnedBase base;
    WorkingSet set;
    Iterate iterate;
    std::vector<double> lag;       ///< N s, by friction pair: error of its spring at the last answer
    std::vector<char> is_stalled;  ///< by friction pair: whether `lag` has not fallen

    explicit BaseInUse(PinnedBase solved)
        : base(std::move(solved)),
          set(base),
          iterate(base.iterate),
          lag(base.slips.size(), std::numeric_limits<double>::infinity()),
          is_stalled(base.slips.size(), 0)
    {
    }

    /// Moves the base's friction springs to the impulses at the present velocity, with the factor as it is.
    /// Returns slip rows that have to join the working set: of pairs whose lag does not fall.
    std::vector<int> move_springs();

    /// Measures how far the base's friction springs are from their law, and whether that is less than the
    /// last time.
    void measure_lag();

    BaseInUse(const BaseInUse&) = delete;  // the set refers to the base
    BaseInUse& operator=(const BaseInUse&) = delete;
};

}  // namespace arris
