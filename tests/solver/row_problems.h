// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <random>
#include <vector>

#include "tests/solver/cloth_system.h"

namespace arris::testing {

/// Placement of rows on the cloth of make_resting_cloth. Single points are in faces anywhere, or in faces
/// about the middle. Many points are in each of 40 faces, spread over the face or close together.
enum class RowPattern { Spread, Patch, Clusters, NearlyEqual };

/// The row of the point with `weights` of three vertices along `direction`.
ConstraintRow make_point_row(const std::array<int, 3>& face, const std::array<double, 3>& weights,
                             const Eigen::Vector3d& direction, double lower, int group);

/// `count` rows along nearly vertical directions. Their bounds differ from the given velocities by smooth
/// waves of up to `speed` (m/s), so about half of the rows are violated.
std::vector<ConstraintRow> make_rows(const ClothShape& shape, const Eigen::VectorXd& velocity,
                                     RowPattern pattern, int count, double speed, unsigned seed);

/// Ways of the rows' springs per multiplier, in the units of the rows as given.
Eigen::VectorXd find_compliances(const VelocityProblem& problem);

/// The vertices of the grid's faces, two faces for each cell.
std::vector<std::array<int, 3>> grid_faces(int side);

/// The unique velocity and multipliers by an independent method: Hildreth's (1957) successive projections on
/// the dual, in extended precision, with bounds and springy rows. For
/// problems of a few well-conditioned unknowns.
struct HildrethAnswer {
    Eigen::VectorXd velocity, multipliers, row_multipliers;
};
HildrethAnswer solve_by_hildreth(const VelocityProblem& problem);

/// The KKT residual, computed in extended precision from the dense matrix and the rows as given. Each row's
/// gap, its spring's way included, and multiplier are scaled by its largest coefficient of a free coordinate.
double dense_kkt_residual_of_rows(const VelocityProblem& problem, const VelocitySolution& solution);

}  // namespace arris::testing
