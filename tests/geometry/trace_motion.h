// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/patch_quality.h"

namespace arris {

struct TraceMotionReport {
    Verdict verdict = Verdict::Done;
    int substeps = 0;
    double fraction = 0.0;          ///< of the way that was made; 1 if done
    std::vector<VertexId> blocked;  ///< as in ClearanceReport, where it ended
};

/// Takes trace vertices to new places, however far, all together and straight: in steps of at most 0.3 of the
/// target length, clearing before each and cleaning up after it. Vertices of the trace that clean-up merges
/// on the way are dropped from the motion; those it adds on an edge between moving vertices move along with
/// that edge. Stops at the last possible step where the way cannot be cleared.
TraceMotionReport move_trace(ClothSurgery& surgery, const MeshTarget& target,
                             const std::vector<VertexMove>& moves);

}  // namespace arris
