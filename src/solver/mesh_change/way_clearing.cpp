// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/way_clearing.h"

#include <algorithm>

#include "geometry/obstacle/feature_nodes.h"
#include "geometry/surgery/material_walk.h"
#include "solver/eol/eol_features.h"
#include "solver/model/eol_limits.h"

namespace arris {

void WayClearing::expect_flow(VertexId v, const Vec2& failed)
{
    if (!trace_.is_on_trace(v)) return;
    const double cell = trace_.target().length(trace_.surgery().material(v)) / soon_;
    const double most = std::max(2.0 * trace_.flow(v).norm(), cell);
    trace_.set_flow(v, failed * std::min(1.0, most / failed.norm()));
}

/// Steps of a vertex's flow that must be clear ahead; with less room the vertex is released.
double WayClearing::least_steps(const EolVertex& eol) const
{
    const ObstaclePose obstacle = trace_.pose_of(eol);
    if (eol.on.is_corner()) return is_tip(obstacle, eol.on.index) ? kClearSteps.tip : kClearSteps.edge;
    return is_on_convex_edge(obstacle, eol) ? kClearSteps.edge : kClearSteps.wire;
}

std::vector<TraceShift> WayClearing::shifts_of(const EolVertex& eol) const
{
    std::vector<TraceShift> shifts;
    for (const VertexId point : trace_.surgery().points_at(eol.vertex_id))
        shifts.push_back({point, soon_ * trace_.flow(point), least_steps(eol) / kClearSteps.edge});
    return shifts;
}

bool WayClearing::leads_off_cloth(const EolVertex& eol) const
{
    const std::vector<TraceShift> shifts = shifts_of(eol);
    return std::any_of(shifts.begin(), shifts.end(), [&](const TraceShift& shift) {
        return leads_off(trace_.surgery(), shift.vertex, shift.least * shift.ahead);
    });
}

std::vector<TraceShift> WayClearing::find_shifts() const
{
    std::vector<TraceShift> shifts;
    for (const EolVertex& eol : trace_.eol()) {
        if (!trace_.is_on_trace(eol.vertex_id)) continue;
        const std::vector<TraceShift> of_vertex = shifts_of(eol);
        shifts.insert(shifts.end(), of_vertex.begin(), of_vertex.end());
    }
    return shifts;
}

ClearanceReport WayClearing::clear(const std::vector<TraceShift>& shifts)
{
    guard_.set_clearing(true);
    ClearanceReport cleared = clear_ahead(trace_.surgery(), trace_.target(), shifts);
    guard_.set_clearing(false);
    ways_ = cleared.ways;
    needed_ = cleared.needed;
    return cleared;
}

void WayClearing::forget_released()
{
    const auto is_gone = [this](const auto& of) { return !trace_.is_on_trace(of.first); };
    std::erase_if(ways_, is_gone);
    std::erase_if(needed_, is_gone);
}

bool WayClearing::keeps_way(const SurgeryEvent& event) const
{
    const auto is_in_way = [&](const PatchFace& face) { return stands_in_way(face); };
    return kept_->empty() || std::none_of(event.after.begin(), event.after.end(), is_in_way) ||
           std::any_of(event.before.begin(), event.before.end(), is_in_way);
}

/// Whether a face stands in a way that is kept clear. A face with vertices under insertion must also stand
/// there when these go their own ways: they move together with others on their obstacle.
bool WayClearing::stands_in_way(const PatchFace& face) const
{
    if (!turns_over(face, *kept_)) return false;
    TraceWays together;
    for (const VertexId v : face.vertices)
        for (const TraceWays* ways : {&coming_, kept_})
            if (const auto at = ways->find(v); at != ways->end()) together[v] = at->second;
    return turns_over(face, together);
}

}  // namespace arris
