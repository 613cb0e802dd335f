// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace arris {

/// AMD of vertices, for Eigen's sparse Cholesky of small systems whose rows 3 v to 3 v + 2 are vertex v's:
/// its three rows have the same neighbours, so it is enough to look at one of them.
struct BlockAmdOrdering {
    using PermutationType = Eigen::AMDOrdering<int>::PermutationType;

    /// `symmetric`: both triangles.
    template <typename Matrix>
    void operator()(const Matrix& symmetric, PermutationType& order) const
    {
        const Eigen::Index n = symmetric.cols() / 3;
        Eigen::SparseMatrix<double> graph(n, n);
        graph.reserve(symmetric.nonZeros() / 9);
        for (Eigen::Index v = 0; v < n; ++v) {
            graph.startVec(v);
            for (typename Matrix::InnerIterator at(symmetric, 3 * v); at; ++at)
                if (at.row() % 3 == 0 && at.row() >= 3 * v) graph.insertBack(at.row() / 3, v) = 1.0;
        }
        graph.finalize();
        PermutationType vertices;
        Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), vertices);
        order.resize(symmetric.cols());
        for (Eigen::Index v = 0; v < n; ++v)
            for (int k = 0; k < 3; ++k) order.indices()[3 * v + k] = 3 * vertices.indices()[v] + k;
    }
};

}  // namespace arris
