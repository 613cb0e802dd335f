// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "geometry/vectors.h"

struct cholmod_common_struct;
struct cholmod_sparse_struct;

namespace arris {

/// Which vertices a matrix of three unknowns a vertex couples: nine times smaller than its pattern.
struct VertexGraph {
    std::vector<int> start = {0};  ///< of each vertex, in `neighbour`; one entry more
    std::vector<int> neighbour;    ///< of vertex v: those w >= v, v included

    VertexGraph() = default;
    /// From a matrix 3n x 3n whose lower triangle consists of whole 3x3 blocks, those on the diagonal
    /// included.
    explicit VertexGraph(const Eigen::SparseMatrix<double>& matrix);

    bool is_of(const Eigen::SparseMatrix<double>& matrix) const;
    int size() const { return static_cast<int>(start.size()) - 1; }
    /// The graph as CHOLMOD takes it: a view.
    cholmod_sparse_struct pattern();
};

/// An elimination order that fills little, by METIS: the vertex eliminated k-th is [k]. A function of the
/// graph alone. Throws std::bad_alloc or std::length_error where the graph does not fit.
std::vector<int> order_by_metis(VertexGraph& graph, cholmod_common_struct& common);

/// An elimination order by nested dissection in the plane (George 1973): parts are cut near the median along
/// one of four directions, where the separator is smallest, and the separator is eliminated last. A function
/// of graph and places alone, several times faster than METIS. `place`: of each vertex, such as its material
/// coordinates.
std::vector<int> dissect(const VertexGraph& graph, const std::vector<Vec2>& place);

}  // namespace arris
