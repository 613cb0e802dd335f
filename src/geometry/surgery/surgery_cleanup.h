// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/surgery/patch_quality.h"

namespace arris {

struct CleanupReport {
    int patch_vertices = 0;  ///< looked at, at the start
    int collapses = 0;
    int flips = 0;
    int splits = 0;
    int most_operations = 0;  ///< proven bound on their sum
    bool is_capped = false;   ///< a cap on flips or rounds was hit: the mesh is valid, perhaps not as good as
                              ///< it could be

    int operations() const { return collapses + flips + splits; }
};

/// Mends the mesh where it was touched since the last time (ClothSurgery::take_touched, and one ring): edges
/// shorter than half the target length are merged, longer than twice it split, faces thinner than the target
/// angle opened. Traces, the border and its corners stay; of two vertices of a trace nearer than half the
/// target length one goes, nodes never. Cost is that of the patch, whatever the size of the mesh. A place
/// that offers nothing better (a feature close to another, or at an acute angle to the border) stays thin.
CleanupReport clean_up(ClothSurgery& surgery, const MeshTarget& target);

}  // namespace arris
