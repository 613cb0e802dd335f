// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace arris {

/// Where the points of a repaired mesh come from. Vertices of the file count from 0.
struct VertexOrigins {
    /// Vertices that the file has, used by an element or not; 0 for a format whose vertices have no order of
    /// their own (all but OBJ, PLY, and glTF for its own animation).
    int vertex_count = 0;
    std::vector<int> of_points;              ///< vertex of each point, the first where several are joined;
                                             ///< -1 for a point that the repair has made
    std::vector<std::array<int, 2>> joined;  ///< the vertex of a point, and another one joined with it
    double tolerance = 0.0;                  ///< m, before scaling: joined vertices are no farther apart
};

/// Renames by `first`, then by `second`. Names are indices; -1 stays.
std::vector<int> compose_names(std::vector<int> first, const std::vector<int>& second);

/// `names`: the name of each vertex, equal for joined ones, -1 for unused ones. `point_names`: the name that
/// each point comes from, -1 for none.
VertexOrigins find_vertex_origins(const std::vector<int>& names, const std::vector<int>& point_names,
                                  double tolerance);

}  // namespace arris
