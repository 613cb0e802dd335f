// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

enum class GridPattern { Diagonal, Alternating, Cross, Unstructured };

/// A straight line through the cloth along which it is bent at the start: material right of the line (from
/// its first to its second point) is turned down about it by `degrees`.
struct Fold {
    std::array<Vec2, 2> line;
    double degrees = 0.0;
};

/// A grid of more vertices than this is refused: SI sizes and cells that make one are a slip of the pen.
inline constexpr double kMostGridVertices = 5e6;

/// A rectangle of cloth [0, size_u] x [0, size_v] to be meshed.
struct ClothGrid {
    Vec2 size = Vec2::Ones();                ///< m
    std::array<int, 2> resolution = {1, 1};  ///< cells along u and v
    GridPattern pattern = GridPattern::Cross;
    double pattern_angle = 0.0;  ///< degrees the pattern is turned inside the rectangle
    std::vector<Fold> folds;     ///< their lines are cut into the mesh
};

/// Flat mesh of the rectangle, world = (u, v, 0), with every fold line (clipped to the rectangle) along mesh
/// edges from border to border; lines may cross and meet. Vertices and faces are a function of the arguments
/// alone. "diagonal", "alternating" (diagonals alternate like a draughtboard) and "cross" (a vertex in each
/// cell's middle) are regular; a turned pattern is clipped to the rectangle, and one with folds keeps what no
/// fold meets. "unstructured" is CGAL's Delaunay refinement at the cells' mean side (measured: within 10 %);
/// it has no direction, so `pattern_angle` does not change it. Least angles, square cells: turned 29 degrees
/// (measured, all angles); with folds 25 where nothing forces less (lines that meet or pass near each other,
/// or near a corner, do); unstructured 20.7 likewise. Other cells: judged in cell coordinates. Border
/// vertices have exactly 0 or the size as coordinate. Throws InputError for sizes or resolutions that are not
/// positive, for more than kMostGridVertices (by the estimate before it is made, and when it is made), and
/// for a fold whose line misses the rectangle.
ClothMesh make_cloth_grid(const ClothGrid& grid);

struct GridCount {
    double vertices = 0.0;
    double faces = 0.0;
};

/// How many vertices and faces make_cloth_grid would make, in no time and for any numbers: exact for a
/// regular pattern unturned and without folds; else measured within 20 % (from 10 cells on), or 40 % for
/// "unstructured" on a rectangle narrower than its cells' mean side. What folds force of "unstructured" is
/// not in it. Throws InputError for what is no rectangle of cells and, for a regular pattern, for folds that
/// miss it.
GridCount estimate_cloth_grid(const ClothGrid& grid);

/// Bends a flat mesh isometrically along `folds`, in order, each turning what lies right of its line about
/// where the line is by then. A line that an earlier fold laid back on itself (180 degrees) is still
/// straight. Throws InputError where a fold's line was not cut into the mesh, and where an earlier fold bent
/// it.
void fold_cloth(const std::vector<Fold>& folds, ClothMesh& mesh);

}  // namespace arris
