// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/surgery/cloth_surgery.h"
#include "solver/model/state.h"

namespace arris {

/// A connected part of the cloth where its mesh or its set of EOL vertices has changed: the changed faces and
/// two rings of faces around them. Rim vertices are shared with faces outside the patch.
struct ChangedPatch {
    std::vector<int> faces;         ///< of the new mesh, ascending
    std::vector<int> faces_before;  ///< faces of the old mesh that cover the patch's material, ascending
    std::vector<int> vertices;      ///< vertices of `faces`, ascending
    std::vector<char> is_inside;    ///< by entry of `vertices`: not on the rim
};

/// Two meshes of one cloth; `faces_at`: faces at each vertex. `after.next_id` is above all ids of `events`.
struct MeshChange {
    const State& before;
    const State& after;
    const std::vector<SurgeryEvent>& events;  ///< operations that led from `before` to `after`
    const VertexFaces& faces_at_before;
    const VertexFaces& faces_at_after;
};

/// Patches in the order of their first faces; no two share a vertex. The cost depends on the number of faces
/// that the events name, and on their surroundings.
std::vector<ChangedPatch> find_changed_patches(const MeshChange& change);

}  // namespace arris
