// SPDX-License-Identifier: GPL-3.0-or-later
// A panel's mesh may have an edge through its inside between two vertices on seams, as across the corner of a
// pillow. The other panel may have one between the same vertices: sewn, four faces would share an edge.
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// The vertex that each vertex of a panel's border becomes when all seams are sewn, or -1 where it is on no
/// seam. The border's vertices are a mesh's first ones, in the order of its loop.
using SewnNumbers = std::vector<int>;

/// Changes the inside of a panel's flat mesh so that panels can be sewn together: no inner edge joins two
/// vertices on seams, no face has three of them, and no two edges join the same vertices once the panel is
/// sewn. Edges are flipped or divided, whichever leaves the larger angles; then inner vertices move to
/// open angles below 30 degrees (angle_relaxation.h, `length` is as there). New vertices follow the others.
/// Two edges of the border that become one are left: only more vertices on the border part them.
void part_seams(const SewnNumbers& sewn, double length, std::vector<Vec2>& places, std::vector<Face>& faces);

}  // namespace arris
