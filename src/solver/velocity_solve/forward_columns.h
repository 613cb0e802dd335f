// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "solver/velocity_solve/factorization.h"

namespace arris {

/// A sparse right-hand side: (unknown, value).
using SparseVector = std::vector<std::pair<int, double>>;

/// The growing matrix G = L^-1 P C of forward-solved sparse columns, and its Gram matrix G^T G. A column is
/// non-zero only on the path from its unknowns to the root of the elimination tree. Only the blocks on that
/// path are computed and kept, in panels of neighbouring columns; several panels at a time. Refers to
/// `factorization`, which must not change.
class ForwardColumns {
  public:
    explicit ForwardColumns(const Factorization& factorization) : factorization_(&factorization) {}

    /// Appends columns in the given order; the cost is least where neighbours in elimination order are
    /// adjacent.
    void append(const std::vector<SparseVector>& columns);

    int size() const { return size_; }
    const Eigen::MatrixXd& gram() const { return gram_; }
    double flops() const { return flops_; }  ///< spent on the columns and their Gram matrix so far
    Eigen::VectorXd dot(const Eigen::VectorXd& forward) const;                             ///< G^T f
    void accumulate(const Eigen::VectorXd& coefficients, Eigen::VectorXd& forward) const;  ///< f += G c

  private:
    /// `width` columns; block k belongs to supernode path[k], transposed: width x columns, column-major.
    struct Panel {
        int first, width;
        std::vector<int> path;  ///< ascending
        std::vector<std::size_t> offset;
        std::vector<double> values;
    };
    void find_path(const SparseVector* columns, Panel& panel) const;
    void solve(const SparseVector* columns, Panel& panel) const;
    double flops_of(const Panel& panel) const;
    double set_gram(const Panel& a, const Panel& b);

    const Factorization* factorization_;
    int size_ = 0;
    double flops_ = 0.0;
    std::vector<Panel> panels_;
    Eigen::MatrixXd gram_;
};

}  // namespace arris
