// SPDX-License-Identifier: GPL-3.0-or-later
// Puts EOL vertices on sites: where the mesh admits one of good quality, by splitting, or by moving a vertex
// that is near through the material.
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

/// The insertions of one surgery. All arguments outlive it.
class SiteInsertion {
  public:
    /// `soon` (s): how long the material that flows must find room.
    SiteInsertion(const Scene& scene, const State& state, const ClothStars& stars, double soon,
                  TraceMesh& trace, const EolAdmission& admission, WayClearing& ways,
                  RefusedContacts& refused);

    /// Puts an EOL vertex on the site, or says why there is none.
    std::optional<RowCause> try_insert(const FeatureSite& site);

    int inserted() const { return inserted_; }

    /// To be called with every operation that is proposed: its first changed vertex may be the one that is
    /// inserted.
    void note_proposal(const SurgeryEvent& event);

  private:
    std::optional<RowCause> insert_vertex(const FeatureSite& site, const Vec2& flow);
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
    const TraceVertex* making_ = nullptr;  ///< the vertex that is being inserted
    VertexId proposed_ = kNoVertex;        ///< the id that it would have
    int inserted_ = 0;
};

}  // namespace arris
