// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps the material ahead of sliding EOL vertices clear. Clears their ways before a step, and refuses later
// operations of that surgery that would put a face in a cleared way.
#pragma once

#include <vector>

#include "geometry/surgery/trace_clearing.h"
#include "solver/mesh_change/mesh_change_guard.h"
#include "solver/model/scene.h"
#include "solver/sites/trace_mesh.h"

namespace arris {

/// Ways of the sliding vertices in one surgery. All arguments outlive it.
class WayClearing {
  public:
    /// `soon` (s): time for which flowing material must find room.
    WayClearing(const Scene& scene, double soon, TraceMesh& trace, MeshChangeGuard& guard)
        : scene_(scene), soon_(soon), trace_(trace), guard_(guard)
    {
    }

    /// Takes `failed` (m/s), with which an earlier attempt at the step has failed, as the vertex's flow. Such
    /// a flow may be far too large. So it is limited to a cell in the time `soon`, or to twice the present
    /// flow.
    void expect_flow(VertexId v, const Vec2& failed);

    /// Whether the cloth's border is so near ahead that clearing cannot help.
    bool leads_off_cloth(const EolVertex& eol) const;

    /// Ways to clear ahead of all vertices on traces, of each of their points.
    std::vector<TraceShift> find_shifts() const;
    ClearanceReport clear(const std::vector<TraceShift>& shifts);

    void forget_released();

    /// During insertion only the ways that are needed soon are kept clear.
    void set_inserting(bool is_inserting) { kept_ = is_inserting ? &needed_ : &ways_; }
    /// Registers a vertex under insertion, with its way (m).
    void add_coming(VertexId v, const Vec2& way) { coming_[v] = way; }
    void erase_coming(VertexId v) { coming_.erase(v); }

    /// Whether an operation keeps the cleared ways clear.
    bool keeps_way(const SurgeryEvent& event) const;

  private:
    std::vector<TraceShift> shifts_of(const EolVertex& eol) const;
    double least_steps(const EolVertex& eol) const;
    bool stands_in_way(const PatchFace& face) const;

    const Scene& scene_;
    double soon_;
    TraceMesh& trace_;
    MeshChangeGuard& guard_;
    TraceWays ways_;                  ///< full ways of the sliding vertices
    TraceWays needed_;                ///< the parts of these ways that are needed soon
    const TraceWays* kept_ = &ways_;  ///< `ways_` or `needed_`
    TraceWays coming_;                ///< ways of vertices inserted in this surgery, or under insertion
};

}  // namespace arris
