// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "geometry/surgery/patch_quality.h"

namespace arris {

/// A trace vertex that is about to move through the material.
struct TraceShift {
    VertexId vertex;
    Vec2 ahead;          ///< m: direction and distance over which the material must be clear
    double least = 1.0;  ///< least share of `ahead` to be clear, else the vertex is blocked; if `ahead` leads
                         ///< off the cloth, only this share is cleared
};

/// Displacements (ways) of trace vertices in the material, m.
using TraceWays = std::map<VertexId, Vec2>;

/// Whether a face would lose its orientation while all vertices go their ways together.
bool turns_over(const PatchFace& face, const TraceWays& ways);

struct ClearanceReport {
    int operations = 0;
    TraceWays ways;    ///< the ways to be cleared, including room ahead of short ones
    TraceWays needed;  ///< the ways that must be clear: `ahead`
    /// Trace vertices with a face that would turn over on the least share of the ways and could not be
    /// cleared: the border, a corner, a fixed vertex, another trace or the guard prevents this. Ascending.
    std::vector<VertexId> blocked;
};

/// Clears the way ahead of moving trace vertices, so that every face keeps its orientation while all of them
/// move together. Vertices in the way are merged into the trace or away from it, or an edge across the way is
/// flipped. Of trace vertices that come upon each other, some are merged and then no longer exist.
/// The way cleared is `ahead`, or 0.3 of the target length where that is longer and does not lead off the
/// cloth. A vertex whose `ahead` is zero counts as resting. Vertices must exist.
ClearanceReport clear_ahead(ClothSurgery& surgery, const MeshTarget& target,
                            const std::vector<TraceShift>& shifts);

}  // namespace arris
