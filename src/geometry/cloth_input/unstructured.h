// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth_input/mesh_lines.h"

namespace arris {

/// Shortest side of a relaxed mesh, relative to the length aimed at: parts of the border that come nearer to
/// one another are mistakes in the outline.
inline constexpr double kShortestSide = 1e-3;

/// CGAL's Delaunay refinement of the cloth between `lines`, with world = (u, v, 0). Edges are about `side`
/// long (m). Vertices begin with the lines' nodes. Throws InputError where lines come so near to one another
/// that the mesh would need more than kMostGridVertices vertices.
ClothMesh make_unstructured(const MeshLines& lines, double side);

/// As make_unstructured, with vertices moved to open angles below 30 degrees. Vertices on a line stay on it,
/// and nodes stay in place. Throws InputError, too, where the mesh would need sides below 1/1000 of `side`.
ClothMesh make_relaxed(const MeshLines& lines, double side);

/// As make_relaxed, for cloth inside a loop whose corners, in order, are the only vertices on the border:
/// what the refinement adds there is taken away before vertices are moved. Sides of the loop should be about
/// `side` long; faces at much shorter ones are thin. `inside`: places within the loop that are vertices,
/// which follow those of the loop.
ClothMesh make_relaxed_inside(const std::vector<Vec2>& loop, const std::vector<Vec2>& inside, double side);

}  // namespace arris
