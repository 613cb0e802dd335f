// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/cloth_input/pattern/pattern_border.h"

namespace arris {

/// A panel's mesh. Material coordinates are the panel's (u, v), or (-u, v) where it is mirrored, so that
/// faces are counter-clockwise and turn to the panel's right side. Vertices on the border come first, in the
/// loop's order, from the first edge's beginning, and then those on lines of ties.
struct PanelMesh {
    ClothMesh mesh;            ///< in the world as placed
    std::vector<int> corners;  ///< the vertex at each edge's beginning, then the count of border vertices
    bool is_mirrored = false;

    /// Vertices on an edge with both its ends, along the loop.
    std::vector<int> vertices_of(int edge) const;
};

struct PatternMesh {
    std::vector<PanelMesh> panels;
    std::vector<std::vector<PanelVertexPair>> seams;  ///< as PatternBorders has them
};

/// Estimates the vertices and faces of all panels, without making them, within about 30 %. For a pattern that
/// has passed check_pattern.
GridCount estimate_pattern(const SewingPattern& pattern, double edge_length);

/// Meshes all panels with edges of about `edge_length`, m: borders as divide_borders, the inside as
/// make_cloth_outline, but that no vertex is added to a border, and with the changes of part_seams. Any
/// choice of whole seams, all of them too, may then be sewn into a mesh that `validate` accepts. Vertices and
/// faces depend on the arguments alone.
///
/// Angles are at least 28 degrees (measured on garments, edges of 1 and 2 cm) except where corners force
/// smaller ones and beside edges of the panel below a third of `edge_length`: 9 degrees beside one of a
/// twentieth.
///
/// Throws InputError as check_pattern does; for an edge length that is not positive or above the largest
/// panel's diagonal; for edges below 1/1000 of the edge length; for loops that cross themselves, or whose
/// area changes by 10 %, once their curves are divided; for more than kMostGridVertices vertices; and where
/// fewer than three edges would go round an opening or a tube.
PatternMesh mesh_pattern(const SewingPattern& pattern, double edge_length);

}  // namespace arris
