// SPDX-License-Identifier: GPL-3.0-or-later
// Inserts EOL vertices at sites, where mesh quality allows: by splitting an edge or face, or by moving a near
// vertex through the material.
#pragma once

#include <optional>

#include "geometry/surgery/trace_insertion.h"
#include "solver/eol/cloth_stars.h"
#include "solver/mesh_change/refused_contacts.h"
#include "solver/mesh_change/way_clearing.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/eol_decision.h"
#include "solver/sites/trace_mesh.h"

namespace arris {

/// Insertions of one surgery. All arguments outlive it.
class SiteInsertion {
  public:
    /// `soon` (s): time for which flowing material must find room.
    SiteInsertion(const Scene& scene, const State& state, const ClothStars& stars, double soon,
                  TraceMesh& trace, const EolAdmission& admission, WayClearing& ways,
                  RefusedContacts& refused);

    /// Inserts an EOL vertex at the site, or returns the cause if there is none.
    std::optional<ConstraintCause> try_insert(const FeatureSite& site);

    int inserted() const { return inserted_; }

    /// Must be called with each proposed operation: the vertex it changes may be the one under insertion.
    void note_proposal(const SurgeryEvent& event);

  private:
    std::optional<ConstraintCause> insert_vertex(const FeatureSite& site, const Vec2& flow);
    void forget_proposal();
    TraceInsertion make_vertex(const Vec2& material, VertexId near, const TraceVertex& wanted);
    std::optional<VertexId> find_beside(const FeatureSite& bend) const;
    bool slide_to(VertexId v, const FeatureSite& bend);
    bool lock_at_bend(VertexId v, const FeatureSite& bend);

    const Scene& scene_;
    const State& state_;
    const ClothStars& stars_;
    double soon_;
    TraceMesh& trace_;
    const EolAdmission& admission_;
    WayClearing& ways_;
    RefusedContacts& refused_;
    const TraceVertex* making_ = nullptr;  ///< the vertex under insertion
    std::vector<VertexId> proposed_;       ///< the points that this vertex would have
    int inserted_ = 0;
};

}  // namespace arris
