// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Points in the plane, and straight edges between them that do not cross. The edges enclose regions to be
/// filled with faces.
struct PlanarGraph {
    std::vector<Vec2> points;
    std::vector<std::array<int, 2>> edges;
    std::vector<std::array<int, 2>> outside;  ///< directed edges with a region on their left to be left out
};

/// Constrained Delaunay triangulation; counter-clockwise faces in a canonical order. Every point is kept.
std::vector<Face> triangulate(const PlanarGraph& graph);

/// Where a refinement stops before it is complete.
struct RefinementLimits {
    std::size_t most_points = 0;
    double shortest_side = 0.0;  ///< m; tested each time the number of points has doubled
};

/// The result of a refinement: `points` begins with the points of the graph.
struct RefinedTriangulation {
    std::vector<Vec2> points;
    std::vector<Face> faces;
    std::vector<std::array<int, 2>> edges;  ///< of the graph, divided; ascending
    bool is_complete = true;
    Vec2 crowded = Vec2::Zero();  ///< if incomplete: where points are densest
    double shortest = 0.0;        ///< if incomplete: length of the side there, m
};

/// CGAL's Delaunay refinement. Angles are at least 20.7 degrees, except
/// beside smaller angles between edges; sides are at most about `size`. Points added on an edge lie on it
/// within rounding, or exactly if the edge is horizontal or vertical.
/// Edges at a distance d from one another force sides of about d between them, however few points the graph
/// has. Refinement therefore stops at `limits`; the result is then not complete and has no faces.
RefinedTriangulation refine(const PlanarGraph& graph, double size, const RefinementLimits& limits);

}  // namespace arris
