// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/patch_quality.h"

namespace arris {

struct TraceMotionReport {
    Verdict verdict = Verdict::Done;
    int substeps = 0;
    double fraction = 0.0;          ///< share of the way that was completed; 1 if done
    std::vector<VertexId> blocked;  ///< vertices blocked at the end, as in ClearanceReport
};

/// Moves trace vertices together along straight lines to new places at any distance. Each step is at most 30
/// % of the target length, with clearing before and clean-up after. Trace vertices that clean-up merges are
/// dropped from the motion. Vertices that clean-up adds on an edge between moving vertices move with that
/// edge. The motion stops at the last possible step if the way cannot be cleared.
TraceMotionReport move_trace(ClothSurgery& surgery, const MeshTarget& target,
                             const std::vector<VertexMove>& moves);

}  // namespace arris
