// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "physics/cloth_elements.h"
#include "physics/linearization.h"
#include "physics/term.h"

namespace arris {

/// Impulse that holds each EOL vertex to its coordinates, N s, in world axes; one entry per vertex of the
/// mesh, zero for other vertices. It is A v' - b before the reduction, where `u` is the step's solution.
///
/// Its component along the first column of the basis is the impulse of the vertex's own contact. Impulses of
/// other contacts are included. The component across, in which the vertex moves with its feature and the
/// material flows, belongs to no contact. `mesh` and `elements` are those of the step's start. All zero where
/// `at.flow` is absent.
std::vector<Vec3> compute_feature_impulses(const ClothMesh& mesh, const ClothElements& elements,
                                           const Terms& terms, const Linearization& at,
                                           const Eigen::VectorXd& u);

}  // namespace arris
