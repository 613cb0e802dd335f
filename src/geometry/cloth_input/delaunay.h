// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Points in the plane, and straight edges between them that do not cross.
struct PlanarGraph {
    std::vector<Vec2> points;
    std::vector<std::array<int, 2>> edges;
};

/// Constrained Delaunay triangulation of the region that the edges enclose; counter-clockwise faces in a
/// canonical order. `filled` lists directed edges with a region on their left that needs no faces. Every
/// point is kept.
std::vector<Face> triangulate(const PlanarGraph& graph, const std::vector<std::array<int, 2>>& filled);

/// The result of a refinement: `points` begins with the points of the graph.
struct RefinedTriangulation {
    std::vector<Vec2> points;
    std::vector<Face> faces;
    bool is_complete = true;
    Vec2 crowded = Vec2::Zero();  ///< if incomplete: where points are densest
    double shortest = 0.0;        ///< if incomplete: length of the side there, m
};

/// CGAL's Delaunay refinement of the region that the edges enclose. Angles are at least 20.7 degrees, except
/// beside smaller angles between edges; sides are at most about `size`. Points added on an edge lie on it
/// within rounding, or exactly if the edge is horizontal or vertical.
/// Edges at a distance d from one another force sides of about d between them, however few points the graph
/// has. Refinement therefore stops above `most_points`; the result is then not complete and has no faces.
RefinedTriangulation refine(const PlanarGraph& graph, double size, std::size_t most_points);

}  // namespace arris
