// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <random>
#include <vector>

#include "tests/solver/cloth_system.h"

namespace arris::testing {

/// Where rows stand on the cloth of make_resting_cloth: single points of faces anywhere, of the faces about
/// the middle, or many points of each of 40 faces, which are anywhere in it or nearly the same.
enum class RowPattern { Spread, Patch, Clusters, NearlyEqual };

/// The row of the point with `weights` of three vertices along `direction`.
ConstraintRow make_point_row(const std::array<int, 3>& face, const std::array<double, 3>& weights,
                             const Eigen::Vector3d& direction, double lower, int group);

/// `count` rows along directions about vertical. They ask for up to `speed` (m/s) more or less, by smooth
/// waves, than the velocities given do, so that about half of these violate them.
std::vector<ConstraintRow> make_rows(const ClothShape& shape, const Eigen::VectorXd& velocity,
                                     RowPattern pattern, int count, double speed, unsigned seed);

/// The vertices of the grid's faces, two a cell.
std::vector<std::array<int, 3>> grid_faces(int side);

/// The unique velocity, and multipliers, by a method that shares nothing with the solver's: Hildreth's (1957)
/// successive projections on the dual, in extended precision, of bounds, and of rows with multipliers up to
/// `row_caps`. For problems of a few well-conditioned unknowns.
struct HildrethAnswer {
    Eigen::VectorXd velocity, multipliers, row_multipliers;
};
HildrethAnswer solve_by_hildreth(const VelocityProblem& problem, const Eigen::VectorXd& row_caps);

/// The KKT residual in extended precision from the dense matrix and the rows as given, each row's gap and
/// multiplier scaled by its largest coefficient of a coordinate that is not fixed. Rows in `gives_way` may be
/// violated.
double dense_kkt_residual_of_rows(const VelocityProblem& problem, const VelocitySolution& solution,
                                  const std::vector<int>& gives_way = {});

}  // namespace arris::testing
