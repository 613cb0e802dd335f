// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps the material ahead of sliding EOL vertices clear: clears their ways before a step, and lets no later
// operation of the same surgery put anything there.
#pragma once

#include <vector>

#include "geometry/surgery/trace_clearing.h"
#include "solver/mesh_change/eol_guard.h"
#include "solver/model/scene.h"
#include "solver/sites/trace_mesh.h"

namespace arris {

/// The ways of one surgery. All arguments outlive it.
class WayClearing {
  public:
    /// `soon` (s): how long the material that flows must find room.
    WayClearing(const Scene& scene, double soon, TraceMesh& trace, EolGuard& guard)
        : scene_(scene), soon_(soon), trace_(trace), guard_(guard)
    {
    }

    /// Takes account of the flow (m/s) with which an attempt at the step has failed. That flow may be wild:
    /// cleared is at most a cell, or twice what the vertex's present flow asks for.
    void expect_flow(VertexId v, const Vec2& failed);

    /// Whether the cloth's border comes so soon that no clearing helps.
    bool leads_off_cloth(const EolVertex& eol) const;

    /// How far the vertices on the trace go.
    std::vector<TraceAdvance> find_advances() const;
    ClearanceReport clear(const std::vector<TraceAdvance>& advances);

    void forget_released();

    /// While vertices are inserted only the ways that are needed soon are kept clear.
    void set_inserting(bool is_inserting) { kept_ = is_inserting ? &needed_ : &ways_; }
    /// A vertex that is being inserted, and its way (m).
    void add_coming(VertexId v, const Vec2& way) { coming_[v] = way; }
    void erase_coming(VertexId v) { coming_.erase(v); }

    /// Whether an operation leaves clear what has been cleared.
    bool keeps_way(const SurgeryEvent& event) const;

  private:
    TraceAdvance advance_of(const EolVertex& eol) const;
    double least_steps(const EolVertex& eol) const;
    bool stands_in_way(const PatchFace& face) const;

    const Scene& scene_;
    double soon_;
    TraceMesh& trace_;
    EolGuard& guard_;
    TraceWays ways_;                  ///< of the vertices that flow, as far as is well
    TraceWays needed_;                ///< as far as they may soon go
    const TraceWays* kept_ = &ways_;  ///< one of the two
    TraceWays coming_;                ///< of vertices that are being inserted, or have been
};

}  // namespace arris
