// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <vector>

namespace arris {

/// Approximate minimum degree (AMD) ordering of vertices, for Eigen's sparse Cholesky of small systems in
/// which rows 3 v to 3 v + 2 belong to vertex v. Two vertices are neighbours if any of their rows are.
struct BlockAmdOrdering {
    using PermutationType = Eigen::AMDOrdering<int>::PermutationType;

    /// `symmetric` must store both triangles.
    template <typename Matrix>
    void operator()(const Matrix& symmetric, PermutationType& order) const
    {
        const Eigen::Index n = symmetric.cols() / 3;
        Eigen::SparseMatrix<double> graph(n, n);
        graph.reserve(symmetric.nonZeros() / 9);
        std::vector<Eigen::Index> below;
        for (Eigen::Index v = 0; v < n; ++v) {
            below.clear();
            for (int k = 0; k < 3; ++k)
                for (typename Matrix::InnerIterator at(symmetric, 3 * v + k); at; ++at)
                    if (at.row() >= 3 * v) below.push_back(at.row() / 3);
            std::sort(below.begin(), below.end());
            below.erase(std::unique(below.begin(), below.end()), below.end());
            graph.startVec(v);
            for (const Eigen::Index w : below) graph.insertBack(w, v) = 1.0;
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
