// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "solver/model/state.h"

namespace arris {

/// Failures of earlier attempts at a step, mostly because too little material was left for the flow.
struct FailedFlow {
    std::map<VertexId, Vec2> flow;  ///< m/s: a flow for which the mesh had too little material at that vertex
    std::set<VertexId> given_up;    ///< vertices that failed without a remedy: they are released
    bool remeshes = true;           ///< whether edges that miss their cells' length are still mended
    std::vector<Vec2> made_at = {};  ///< material, m: places where new EOL vertices had too little material
    /// Whether one of `made_at` is nearer than `reach` (m) to a material point.
    bool has_failed_near(const Vec2& material, double reach) const
    {
        return std::any_of(made_at.begin(), made_at.end(),
                           [&](const Vec2& at) { return (at - material).norm() < reach; });
    }
    bool empty() const { return flow.empty() && given_up.empty() && made_at.empty(); }
};

}  // namespace arris
