// SPDX-License-Identifier: GPL-3.0-or-later
// A contact with a sharp feature is a row first. Where it pressed at the end of the last step the mesh gets a
// vertex there, if it admits one of good quality, and edges along the feature from one to the next; where it
// does not, the contact stays a row, which is always safe: any of this may be refused.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "solver/eol/cloth_stars.h"
#include "solver/mesh_change/eol_guard.h"
#include "solver/model/failed_flow.h"
#include "solver/model/row_cause.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/eol_decision.h"
#include "solver/sites/feature_sites.h"

namespace arris {

struct ConformReport {
    int inserted = 0, released = 0, operations = 0;
};

/// What the surgery has done and who is EOL now.
struct ConformedMesh {
    SurgeryResult surgery;
    std::vector<SurgeryEvent> events;
    std::vector<EolVertex> eol;  ///< ascending by vertex_id
    ConformReport report;
};

/// What features ask of the mesh, whatever may strain it.
struct FeatureChanges {
    std::vector<EolRelease> released;  ///< in the order of the state's EOL vertices
    std::vector<FeatureSite> sites;    ///< where there may be new ones
    bool empty() const { return released.empty() && sites.empty(); }
};

/// `stars` are the state's. Nothing without a target for the mesh.
FeatureChanges find_feature_changes(const Scene& scene, const State& state, const ClothStars& stars);

/// How carefully a mesh is made, and what it may cost.
struct ConformLimits {
    StrainLimit strain = StrainLimit::GivesWay;
    /// Vertices, ascending: operations that replace a face at one of them are judged as with
    /// StrainLimit::AsMade.
    std::vector<VertexId> careful_at = {};
    // Of more the mesh is of no use.
    int lost = std::numeric_limits<int>::max();     ///< the most that ConformOutcome::lost may come to
    int blocked = std::numeric_limits<int>::max();  ///< the same of ConformOutcome::blocked
};

/// What `conform_mesh` found.
struct ConformOutcome {
    std::optional<ConformedMesh> mesh;    ///< nothing where it is right as it is
    std::vector<RefusedContact> refused;  ///< that pressed on a feature and stay or become rows
    int lost = 0;     ///< EOL vertices that clearing has cost: blocked, or merged into others
    int blocked = 0;  ///< of these what clearing met and could not move
    /// Vertices, ascending, at which something may have been done that relies on cloth that gives way.
    std::vector<VertexId> relies_at;
};

/// The mesh that the next step of at most `dt` (s) wants: EOL vertices where features pressed, none where
/// they have not for long, the way of those that slide cleared, what they left restored. `stars` and
/// `changes` are the state's, `relaxations` the scene's. Unfinished, without a mesh, where clearing what is
/// there loses more than it may.
ConformOutcome conform_mesh(const Scene& scene, double dt, const State& state, const ClothStars& stars,
                            const FeatureChanges& changes, const FailedFlow& failed,
                            const ConformLimits& limits, RelaxationMemo& relaxations);

}  // namespace arris
