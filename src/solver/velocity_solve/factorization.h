// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "geometry/vectors.h"
#include "solver/velocity_solve/elimination_tree.h"

namespace arris {

/// One dense block of L: `columns` consecutive columns, which share the row indices
/// `rows`. The first `columns` rows are the triangle on the diagonal. Column-major, leading dimension
/// `row_count`.
struct Supernode {
    int first;  ///< column of L
    int columns;
    const int* rows;
    int row_count;
    const double* values;
};

/// Sparse Cholesky P A P^T = L L^T of a symmetric positive definite matrix with three unknowns a vertex, in
/// which chosen coordinates are pinned. Rows and columns of pinned coordinates are replaced by a diagonal, so
/// that the pattern and its symbolic analysis, CHOLMOD's, do not depend on the pins. The numeric
/// factorisation is multifrontal (Duff and Reid 1983): supernodes that do not depend on each other, and tiles
/// of large ones, are worked on by several threads, with a BLAS of one thread. Each supernode takes its
/// children's updates in their order, so results do not depend on the number of threads.
class Factorization {
  public:
    Factorization();
    ~Factorization();
    Factorization(Factorization&&) noexcept;
    Factorization& operator=(Factorization&&) noexcept;

    /// Orders the unknowns if the pattern has changed; else only compares the index arrays. `matrix`:
    /// compressed, whole 3x3 blocks of the lower triangle; entries above the diagonal are ignored. `place`:
    /// of each vertex in a plane, for nested dissection there; without it, METIS orders. Throws
    /// std::bad_alloc or std::length_error where the factor does not fit.
    void analyse(const Eigen::SparseMatrix<double>& matrix, const std::vector<Vec2>* place = nullptr);

    /// Numeric factorisation of the matrix analysed last. False where it is not positive definite.
    bool factorise(const Eigen::SparseMatrix<double>& matrix, const std::vector<char>& is_pinned);

    Eigen::VectorXd solve_forward(const Eigen::VectorXd& rhs) const;       ///< L^-1 P rhs
    Eigen::VectorXd solve_backward(const Eigen::VectorXd& forward) const;  ///< P^T L^-T forward

    /// Place of each unknown in the elimination order: (P x)[position()[i]] = x[i].
    const std::vector<int>& position() const;

    const EliminationTree& tree() const;
    Supernode supernode(int index) const;
    double nonzeros() const;  ///< stored entries of L
    double flops() const;     ///< floating-point operations of `factorise`
    double critical_flops() const;  ///< of its longest chain of tasks (TreeWalk)

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace arris
