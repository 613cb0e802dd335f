// SPDX-License-Identifier: GPL-3.0-or-later
// Cloths with EOL vertices for the tests of elements and systems: random, but reproducible.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <random>

#include "geometry/cloth_input/cloth_grid.h"
#include "physics/system/linear_system.h"

namespace arris {

using Generator = std::mt19937_64;

/// A random vector with components between -size and size.
Vec2 random2(Generator& random, double size);
Vec3 random3(Generator& random, double size);

/// A crumpled 1 m sheet whose mesh lines are perturbed in the material, too.
ClothMesh crumpled_sheet(std::array<int, 2> resolution, GridPattern pattern, unsigned seed);

/// A linearisation with random entries and one of two vertices EOL. The mesh is at q^; the extrapolated state
/// differs slightly.
Linearization random_linearization(const ClothMesh& mesh, unsigned seed);

/// A linearisation with gamma = 1 at the mesh's own state, at rest: rhs = B^T f_x + E^T f_X.
Linearization linearization_at_rest(const ClothMesh& mesh, unsigned seed);

struct Assembled {
    Eigen::MatrixXd matrix;  ///< both triangles
    Eigen::VectorXd rhs;
};

Assembled assemble(const ClothMesh& mesh, const Terms& terms, const Linearization& at);

Terms only(std::unique_ptr<const FaceTerm> term);

}  // namespace arris
