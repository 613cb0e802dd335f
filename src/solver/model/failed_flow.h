// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "solver/model/state.h"

namespace arris {

/// What earlier attempts of a step have found out about the flow of material.
struct FailedFlow {
    std::map<VertexId, Vec2> flow;   ///< m/s: with it the mesh had not enough material at that vertex
    std::set<VertexId> given_up;     ///< vertices for which no attempt had room: they are released
    std::vector<Vec2> made_at = {};  ///< material, m: where new EOL vertices had not enough
    /// Whether one of `made_at` is nearer than `reach` (m) to a material point.
    bool has_failed_near(const Vec2& material, double reach) const
    {
        return std::any_of(made_at.begin(), made_at.end(),
                           [&](const Vec2& at) { return (at - material).norm() < reach; });
    }
    bool empty() const { return flow.empty() && given_up.empty() && made_at.empty(); }
};

}  // namespace arris
