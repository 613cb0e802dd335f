// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "solver/velocity_solve/tree_walk.h"
#include "solver/velocity_solve/update_places.h"
#include "solver/velocity_solve/vertex_ordering.h"

namespace arris {

/// A 3x3 block of A's lower triangle, and the place in L from which it is eliminated.
struct MatrixBlock {
    int row, column;        ///< vertices of A; row >= column
    int source, stride;     ///< first entry in A, and entries from one column to the next
    std::ptrdiff_t target;  ///< first entry in L
    bool is_turned;         ///< L has its transpose there
};

/// What a numeric factorisation needs to know of the matrix's pattern.
struct SymbolicFactor {
    EliminationTree tree;
    TreeWalk walk;
    UpdatePlaces updates;
    std::vector<int> position;     ///< of each unknown in the elimination order
    std::vector<int> first_block;  ///< of each supernode, in `blocks`; one entry more
    std::vector<MatrixBlock> blocks;
    double flops = 0.0;

    /// `of_vertices`: CHOLMOD's supernodal symbolic factor of `graph`.
    SymbolicFactor(const Eigen::SparseMatrix<double>& matrix, const VertexGraph& graph,
                   const cholmod_factor_struct& of_vertices);
    SymbolicFactor(const SymbolicFactor&) = delete;  // the walk refers to the tree
    SymbolicFactor& operator=(const SymbolicFactor&) = delete;
};

}  // namespace arris
