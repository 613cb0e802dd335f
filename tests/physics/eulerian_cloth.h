// SPDX-License-Identifier: GPL-3.0-or-later
// Cloths with EOL vertices for the tests of elements and systems: random, but the same every time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <random>

#include "geometry/cloth_input/cloth_grid.h"
#include "physics/linear_system.h"

namespace arris {

using Generator = std::mt19937_64;

/// Components between -size and size.
Vec2 random2(Generator& random, double size);
Vec3 random3(Generator& random, double size);

/// A crumpled 1 m sheet whose mesh follows no lines.
ClothMesh crumpled_sheet(std::array<int, 2> resolution, GridPattern pattern, unsigned seed);

/// Everything of the linearisation random, one vertex in two EOL, the mesh at q^ and where it is extrapolated
/// to a little different.
Linearization random_linearization(const ClothMesh& mesh, unsigned seed);

/// gamma = 1, everything at rest where the mesh is: rhs = B^T f_x + E^T f_X.
Linearization linearization_at_rest(const ClothMesh& mesh, unsigned seed);

struct Assembled {
    Eigen::MatrixXd matrix;  ///< whole
    Eigen::VectorXd rhs;
};

Assembled assemble(const ClothMesh& mesh, const Terms& terms, const Linearization& at);

Terms only(std::unique_ptr<const FaceTerm> term);

}  // namespace arris
