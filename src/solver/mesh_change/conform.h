// SPDX-License-Identifier: GPL-3.0-or-later
// Conforms the mesh to the features that press. A contact with a sharp feature is a constraint at first. If
// it pressed at the end of the last step, the mesh gets an EOL vertex on the feature, where quality allows.
// Mesh edges along the feature then join such vertices. Every operation may be refused: the contact then
// stays a constraint, which is always safe.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "solver/eol/cloth_stars.h"
#include "solver/mesh_change/mesh_change_guard.h"
#include "solver/model/constraint_cause.h"
#include "solver/model/failed_flow.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/sites/eol_decision.h"
#include "solver/sites/feature_sites.h"

namespace arris {

struct ConformReport {
    int inserted = 0, released = 0;
    int remeshed = 0;  ///< operations where edges missed their cells' length
};

/// The mesh after surgery, and its EOL vertices.
struct ConformedMesh {
    SurgeryResult surgery;
    std::vector<SurgeryEvent> events;
    std::vector<EolVertex> eol;  ///< ascending by vertex_id
    ConformReport report;
};

/// Changes of the mesh that features and cell lengths require, before any limit on strain.
struct MeshChanges {
    std::vector<EolRelease> released;              ///< in the order of the state's EOL vertices
    std::vector<FeatureSite> sites;                ///< where new EOL vertices may be
    std::vector<std::array<VertexId, 2>> misfits;  ///< edges to split or merge (remesh/misfits.h)
    bool empty() const { return released.empty() && sites.empty() && misfits.empty(); }
};

/// Finds these changes. `stars` belong to the state. Empty in a scene without EOL vertices and remeshing.
MeshChanges find_mesh_changes(const Scene& scene, const State& state, const ClothStars& stars);

/// Limits for making a mesh: on strain, and on EOL vertices that clearing loses.
struct ConformLimits {
    StrainLimit strain = StrainLimit::GivesWay;
    /// Vertices, ascending. Operations that replace a face at one of these are judged as with
    /// StrainLimit::AsMade.
    std::vector<VertexId> careful_at = {};
    /// On ConformOutcome::lost: a mesh that exceeds it is left unfinished.
    int lost = std::numeric_limits<int>::max();
};

/// Result of `conform_mesh`.
struct ConformOutcome {
    std::optional<ConformedMesh> mesh;    ///< nothing where the mesh stays as it is
    std::vector<RefusedContact> refused;  ///< contacts that pressed on a feature and are constraints
    int lost = 0;                         ///< EOL vertices that clearing blocked, or merged into others
    /// Vertices, ascending, of operations that the guard allowed only because the cloth around gives way.
    std::vector<VertexId> relies_at;
};

/// Makes the mesh for the next step, of at most `dt` (s). Inserts EOL vertices where features pressed,
/// releases others by `find_releases`, clears the way of sliding ones and cleans up behind them; splits
/// and merges edges that miss their cells. `stars`
/// and `changes` belong to the state, `relaxations` to the scene. Returns no mesh where nothing changes, or
/// where clearing exceeds `limits.lost`.
ConformOutcome conform_mesh(const Scene& scene, double dt, const State& state, const ClothStars& stars,
                            const MeshChanges& changes, const FailedFlow& failed, const ConformLimits& limits,
                            RelaxationMemo& relaxations);

}  // namespace arris
