// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

enum class GridPattern { Diagonal, Alternating, Cross, Unstructured };

/// A straight fold line of the initial cloth. The material right of the line (from its first to its second
/// point) is turned down about the line by `degrees`.
struct FoldLine {
    std::array<Vec2, 2> line;
    double degrees = 0.0;
};

/// Largest number of vertices of a grid. A grid with more is probably an error in its size or cells.
inline constexpr double kMostGridVertices = 5e6;

/// A rectangle of cloth [0, size_u] x [0, size_v] to be meshed.
struct ClothGrid {
    Vec2 size = Vec2::Ones();                ///< m
    std::array<int, 2> resolution = {1, 1};  ///< cells along u and v
    GridPattern pattern = GridPattern::Cross;
    double pattern_angle = 0.0;   ///< degrees by which the pattern is turned in the rectangle
    std::vector<FoldLine> folds;  ///< mesh edges are made along their lines
};

/// Makes a flat mesh of the rectangle, with world = (u, v, 0). Mesh edges run along every fold line (clipped
/// to the rectangle) from border to border; fold lines may cross and meet. Vertices and faces depend on the
/// arguments alone. Border vertices have exactly 0 or the size as coordinate.
///
/// The patterns "diagonal", "alternating" (diagonals alternate as on a draughtboard) and "cross" (a vertex in
/// the middle of each cell) are regular. A turned pattern is clipped to the rectangle; a pattern with folds
/// keeps the faces that no fold line meets. "unstructured" is CGAL's Delaunay refinement with the cells' mean
/// side as edge length (measured: within 10 %). It has no direction, so `pattern_angle` does not change it.
///
/// Least angles with square cells: 29 degrees for a turned pattern (measured over all angles), 25 with folds,
/// 20.7 for "unstructured". Fold lines that meet or pass near one another, or near a corner, may force
/// smaller angles. Angles in other cells are judged in cell coordinates.
///
/// Throws InputError if a size or resolution is not positive, if a fold's line misses the rectangle, or for
/// more than kMostGridVertices vertices (estimated before the mesh is made, and counted after).
ClothMesh make_cloth_grid(const ClothGrid& grid);

struct GridCount {
    double vertices = 0.0;
    double faces = 0.0;
};

/// Estimates how many vertices and faces make_cloth_grid would make, without making them. Exact for a regular
/// pattern that is not turned and has no folds. Otherwise the measured error is at most 20 % (from 10 cells
/// on), or 40 % for "unstructured" on a rectangle narrower than its cells' mean side. Vertices that folds
/// force on "unstructured" are not counted. Throws InputError for an invalid rectangle or resolution and, for
/// a regular pattern, for folds that miss the rectangle.
GridCount estimate_cloth_grid(const ClothGrid& grid);

/// Bends a flat mesh isometrically along `folds`, in order. Each fold turns the material right of its line
/// about the line's current place in the world. A line that an earlier fold laid back on itself (180 degrees)
/// is still straight. Throws InputError if a fold's line is not along mesh edges, or if an earlier fold bent
/// the line.
void fold_cloth(const std::vector<FoldLine>& folds, ClothMesh& mesh);

}  // namespace arris
