// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "geometry/self_contact/near_pairs.h"
#include "geometry/self_contact/self_contact.h"

namespace arris {

/// Result of checking a step's motion of the cloth against itself. Clean: no two elements met on the way.
struct SelfSweepReport {
    std::vector<SelfContact> violations;  ///< planes that would have prevented the meetings; the first
                                          ///< meeting of each vertex, and of each pair of edges
    int crossings = 0;       ///< number of vertices that met a face, and of edges that met an edge
    std::vector<int> faces;  ///< that met another one, ascending

    bool is_clean() const { return faces.empty(); }
};

/// Whether a vertex and a face, or two edges (indices in the surface), may meet. Called from several threads.
using MayMeet = std::function<bool(SelfContactKind kind, int first, int second)>;

/// Checks every vertex against every face and every edge against every edge, but pairs that `may_meet`, if
/// given. No touch is missed. `thickness` (m) limits the gaps that the violations' planes keep. Positions
/// must be finite.
SelfSweepReport check_self_sweep(const SelfSurface& surface, const SelfMotion& motion, double thickness,
                                 const MayMeet& may_meet = {});

}  // namespace arris
