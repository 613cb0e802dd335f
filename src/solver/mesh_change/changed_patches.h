// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/surgery/cloth_surgery.h"
#include "solver/model/state.h"

namespace arris {

/// A connected part of the cloth that a change of its mesh, or of who is EOL, concerns: what has changed and
/// two rings of faces around it. Vertices at its rim are those it shares with faces that are not in it.
struct ChangedPatch {
    std::vector<int> faces;         ///< of the mesh after, ascending
    std::vector<int> faces_before;  ///< that cover the same part of the material, ascending
    std::vector<int> vertices;      ///< after, of `faces`, ascending
    std::vector<char> is_inside;    ///< of each of these: not at the rim
};

/// Two meshes of one cloth; `faces_at`: faces at each vertex. `after.next_id` is above all ids of `events`.
struct MeshChange {
    const State& before;
    const State& after;
    const std::vector<SurgeryEvent>& events;  ///< that led from one to the other
    const VertexFaces& faces_at_before;
    const VertexFaces& faces_at_after;
};

/// In the order of their first faces; no two share a vertex. Looks at what the events name, and
/// around it.
std::vector<ChangedPatch> find_changed_patches(const MeshChange& change);

}  // namespace arris
