// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/cloth_input/mesh_lines.h"

namespace arris {

/// A flat piece of cloth of any shape, to be meshed.
struct ClothOutline {
    BorderLoops border;           ///< the outline, then the holes
    double edge_length = 0.0;     ///< m, aimed at
    std::vector<FoldLine> folds;  ///< mesh edges are made along their lines
};

/// Largest number of corners of an outline with its holes.
inline constexpr int kMostOutlineCorners = 100000;

/// Change of the area, relative, by which a mesh is no longer of its outline's shape: a disc becomes an
/// octagon.
inline constexpr double kOtherShape = 0.1;

/// Throws InputError where edges of `edge_length` (m) would give more than kMostGridVertices `vertices`.
void require_few_vertices(double edge_length, double vertices);

/// Makes loops of polygons that may run in either direction and repeat a corner (at once, or the first corner
/// at the end). Coordinates must be finite.
BorderLoops to_border_loops(const std::vector<Vec2>& outline, const std::vector<std::vector<Vec2>>& holes);

/// What is wrong with a border, and what is allowed.
struct BorderDefect {
    int loop = 0;  ///< in the border
    std::string wrong, allowed;
};

/// Finds the first defect of a border: a loop without three different corners, sides that cross or touch, a
/// hole that is outside the outline or in another hole, more than kMostOutlineCorners corners, a place more
/// than 1000 times its size from the origin. The outline is tested before its holes. Exact.
std::optional<BorderDefect> find_border_defect(const BorderLoops& border);

/// Area inside the outline without the holes, m^2.
double area_of(const BorderLoops& border);

/// Leaves out corners of `border` that are fine for a mesh with edges of `edge_length`. A corner is left out
/// where the side that replaces those at it is at most 4/3 `edge_length` long, and at most 7 % of
/// `edge_length` away from all corners left out along it. The border still touches nothing (CGAL's polyline
/// simplification); sides from 0.7 `edge_length` on keep their corners. The border must have no defect.
BorderLoops coarsen_border(const BorderLoops& border, double edge_length);

/// Estimates the vertices and faces that make_cloth_outline would make, without making them: within 30 %
/// (measured), and too low where parts of the border or folds are nearer to one another than `edge_length`.
GridCount estimate_cloth_outline(const ClothOutline& outline);

/// Makes a flat mesh of the cloth, with world = (u, v, 0): CGAL's Delaunay refinement, whose vertices are
/// then moved to open angles below 30 degrees. Every corner of the border is a vertex, border vertices lie on
/// the border, and mesh edges run along every fold line. Vertices and faces depend on the arguments alone.
///
/// Angles are at least 25 degrees (measured) except where corners, or parts of the border or folds near one
/// another, force smaller ones; sides are 0.45 to 1.75 times the edge length, except there, too, and at
/// curves with a radius below three edge lengths.
///
/// The border must have no defect. Throws InputError if a fold's line misses the cloth, for more than
/// kMostGridVertices vertices (estimated before the mesh is made, and counted while it is), or for sides
/// below 1/1000 of the edge length.
ClothMesh make_cloth_outline(const ClothOutline& outline);

}  // namespace arris
