// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Target edge lengths, m, that the cloth's present shape and motion ask for: one at each node of the
/// remeshing grid. In a box of two cells' width around the node,
///  - the surface turns by at most `angle` over an edge. Curvature is the mean of the hinges' second
///    fundamental forms, theta |e| m m^T by area (m: unit normal of the edge in the material), or half the
///    mean of their sizes where those of a zigzag cancel. Folds on features are left out: EOL vertices
///    resolve them.
///  - cloth compressed by more than `compression` has at least two cells to a wrinkle's half wave, and at
///    most twice as many as before.
///  - velocity differs by at most `velocity` over an edge.
/// Along sliding folds, cells are at least so long that a step's flow takes half of one. At pins and pulls on
/// a single point they are at least as long as those of the first mesh. A cell is at most kGradation longer
/// than another for each metre between them. All are longer by one factor where the mesh would have more than
/// `most_vertices` vertices.
std::vector<float> find_wanted_lengths(const Scene& scene, const State& state, const ClothStars& stars);

}  // namespace arris
