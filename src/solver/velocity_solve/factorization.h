// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "solver/velocity_solve/vertex_ordering.h"

namespace arris {

/// One dense block of L as CHOLMOD stores it: `columns` consecutive columns, which share the row indices
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
/// that the pattern and its symbolic analysis do not depend on the pins. One BLAS thread: results must not
/// depend on the thread count, and with small blocks on a loaded machine more threads cost up to 47 times
/// more.
class Factorization {
  public:
    explicit Factorization(VertexOrdering ordering = VertexOrdering::Metis);
    ~Factorization();
    Factorization(Factorization&&) noexcept;
    Factorization& operator=(Factorization&&) noexcept;

    /// Orders the unknowns if the pattern has changed; else only compares the index arrays. `matrix`:
    /// compressed, lower triangle with every diagonal entry; entries above the diagonal are ignored. Throws
    /// std::bad_alloc or std::length_error where the factor does not fit.
    void analyse(const Eigen::SparseMatrix<double>& matrix);

    /// Numeric factorisation of the matrix analysed last. False where it is not positive definite.
    bool factorise(const Eigen::SparseMatrix<double>& matrix, const std::vector<char>& is_pinned);

    Eigen::VectorXd solve_forward(const Eigen::VectorXd& rhs) const;       ///< L^-1 P rhs
    Eigen::VectorXd solve_backward(const Eigen::VectorXd& forward) const;  ///< P^T L^-T forward

    /// Place of each unknown in the elimination order: (P x)[position()[i]] = x[i].
    const std::vector<int>& position() const;

    int supernode_count() const;
    Supernode supernode(int index) const;
    int supernode_of(int position) const;
    int parent(int supernode) const;  ///< in the elimination tree; -1 at a root
    double nonzeros() const;          ///< stored entries of L
    double flops() const;             ///< floating-point operations of `factorise`

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace arris
