// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <random>
#include <vector>

#include "solver/velocity_solve/velocity_solve.h"

namespace arris::testing {

/// A square grid of `side` x `side` vertices, wrinkled, one metre wide.
struct ClothShape {
    int side = 10;
    double stretch = 1000.0;  ///< Young's modulus times thickness, N/m
    double bending = 1e-4;    ///< N m
    double density = 0.1;     ///< kg/m^2
    double step = 0.005;      ///< s
    double wrinkle = 0.02;    ///< height of the wrinkles, m
    double aspect = 1.0;      ///< how much longer than wide the cells are
    unsigned seed = 1;
};

/// An implicit step of a SampleCloth: M + h^2 K in the form of VelocityProblem, masses and vertex positions.
struct ClothSystem {
    Eigen::SparseMatrix<double> matrix;
    Eigen::VectorXd mass;                   ///< one for each unknown, kg
    std::vector<Eigen::Vector3d> position;  ///< m
};
ClothSystem make_cloth_system(const ClothShape& shape);

struct OwnedProblem {
    Eigen::SparseMatrix<double> matrix;
    Eigen::VectorXd rhs;
    VelocityProblem problem;

    OwnedProblem(Eigen::SparseMatrix<double> a, Eigen::VectorXd b);
    OwnedProblem(const OwnedProblem& other);
    OwnedProblem& operator=(const OwnedProblem&) = delete;
    void set_matrix(Eigen::SparseMatrix<double> a);
};

/// A SampleCloth that falls onto a floor with broad waves; a `share` of its vertices would reach the floor in
/// the step.
OwnedProblem make_resting_cloth(const ClothShape& shape, double share);

/// Lower triangle and full 3x3 diagonal blocks of a dense symmetric matrix, every entry stored. Entries above
/// the diagonal are filled with nonsense, because the solver must not read them.
Eigen::SparseMatrix<double> lower_blocks(const Eigen::MatrixXd& matrix);

/// The whole symmetric matrix from the lower triangle.
Eigen::MatrixXd dense_symmetric(const Eigen::SparseMatrix<double>& matrix);

/// Coordinates with a positive multiplier, ascending.
std::vector<int> active_coordinates(const VelocitySolution& solution);

/// `guess` with `share` of its members dropped, and as many others put in from the coordinates with a bound.
std::vector<int> spoil_guess(const VelocityProblem& problem, const std::vector<int>& guess, double share,
                             std::mt19937& random);

}  // namespace arris::testing
