// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "geometry/surgery/patch_quality.h"

namespace arris {

/// A trace vertex that is about to move through the material.
struct TraceAdvance {
    VertexId vertex;
    Vec2 ahead;          ///< m: how far, and in which direction, the material must be clear
    double least = 1.0;  ///< share of that without which the vertex is blocked; no more where it leads off
                         ///< the cloth
};

/// Ways of trace vertices through the material, m.
using TraceWays = std::map<VertexId, Vec2>;

/// Whether a face would lose its orientation while all of them go their ways together.
bool turns_over(const PatchFace& face, const TraceWays& ways);

struct ClearanceReport {
    int operations = 0;
    TraceWays ways;    ///< that were to be cleared
    TraceWays needed;  ///< of these what must be: `ahead`
    /// Trace vertices with a face that would turn over on the least of the ways and could not be cleared: the
    /// border, a corner, a fixed vertex, another trace or the guard stands there. Ascending.
    std::vector<VertexId> blocked;
};

/// Clears the way ahead of moving trace vertices, so that every face keeps its orientation while all of them
/// go their way together: what stands there is merged into the trace, or away from it, or an edge across the
/// way is flipped; of vertices of a trace that come upon each other some are merged, and are gone then. The
/// way is at least 0.3 of the target length long where that does not lead off the cloth, or `ahead` where
/// that is longer; a vertex whose `ahead` is zero counts as resting. Vertices must exist.
ClearanceReport clear_ahead(ClothSurgery& surgery, const MeshTarget& target,
                            const std::vector<TraceAdvance>& advances);

}  // namespace arris
