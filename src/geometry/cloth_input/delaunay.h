// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Points in the plane and straight edges between them that cross nowhere.
struct PlanarGraph {
    std::vector<Vec2> points;
    std::vector<std::array<int, 2>> edges;
};

/// Constrained Delaunay triangulation of what the edges enclose, counter-clockwise faces in a canonical
/// order. `filled` are those edges (directed) left of which is a region that needs no faces. Every point
/// stays.
std::vector<Face> triangulate(const PlanarGraph& graph, const std::vector<std::array<int, 2>>& filled);

/// The result of a refinement: `points` begins with those given.
struct RefinedTriangulation {
    std::vector<Vec2> points;
    std::vector<Face> faces;
    bool is_complete = true;
    Vec2 crowded = Vec2::Zero();  ///< where the points are densest, if it is not complete
    double shortest = 0.0;        ///< m, the side there
};

/// CGAL's Delaunay refinement of what the edges enclose: angles of at least 20.7 degrees except beside
/// smaller angles between edges, sides of at most about `size`. Points added on an edge lie on it to
/// rounding; those on a horizontal or vertical one exactly.
/// Edges that come within d of one another force sides of about d between them, however few the points of the
/// graph: the refinement stops above `most_points` and is not complete then (and has no faces).
RefinedTriangulation refine(const PlanarGraph& graph, double size, std::size_t most_points);

}  // namespace arris
