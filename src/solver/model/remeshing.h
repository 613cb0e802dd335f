// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/material_grid.h"
#include "geometry/cloth/mesh_target.h"

namespace arris {

/// How fine adaptive remeshing makes the mesh.
struct Remeshing {
    double shortest = 0.01, longest = 0.1;  ///< m, edge lengths to aim at
    double angle = 0.5236;                  ///< rad, by which the surface may turn over one edge
    double compression = 0.005;  ///< compressive strain above which cloth gets finer cells, to buckle in
    double velocity = 0.5;       ///< m/s, difference of velocity allowed over one edge
    double aspect = 0.2;         ///< least height of a face over its longest edge
    int most_vertices = 0;       ///< about the most to make; 0: a multiple of the first mesh's
    double step = 0.005;         ///< s, a planned time step: material does not flow past a whole cell in it

    // Set by measure_first_mesh (remesh/sizing_field.h).
    MeshTarget initial;  ///< of the first mesh: its mean length, and least angles
    MaterialGrid grid;   ///< of State::sizing_field
};

}  // namespace arris
