// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/surgery/patch_quality.h"

namespace arris {

struct CleanupReport {
    int patch_vertices = 0;  ///< number of vertices in the patch at the start
    int collapses = 0;
    int flips = 0;
    int splits = 0;
    int most_operations = 0;  ///< proven bound on the sum of the operations

    int operations() const { return collapses + flips + splits; }
};

/// Mends the mesh where it was touched since the last time (ClothSurgery::take_touched, and one ring). Edges
/// shorter than half the target length are merged, edges longer than twice the target length are split, and
/// faces thinner than the target angle are opened. Traces, the border and its corners stay. Of two OnTrace
/// vertices nearer than half the target length, one is removed; nodes are never removed. The cost depends on
/// the patch, not on the size of the mesh. A face stays thin if no operation improves it (features close
/// together, or at an acute angle to the border).
CleanupReport clean_up(ClothSurgery& surgery, const MeshTarget& target);

}  // namespace arris
