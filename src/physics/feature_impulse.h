// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "physics/cloth_elements.h"
#include "physics/linearization.h"
#include "physics/term.h"

namespace arris {

/// What holds each EOL vertex to its coordinates, N s, one a vertex of the mesh, zero for the others: A v' -
/// b before the reduction, along the world's axes, where `u` is the step's solution. The impulse of its own
/// contact is its part along the basis' first column, that of other contacts is contained; the part across,
/// in which the vertex goes with its feature and the material flows, is in none of them. `mesh` and
/// `elements` are those of the step's start. Zero where `at.flow` is absent.
std::vector<Vec3> compute_feature_impulses(const ClothMesh& mesh, const ClothElements& elements,
                                           const Terms& terms, const Linearization& at,
                                           const Eigen::VectorXd& u);

}  // namespace arris
