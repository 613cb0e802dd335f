// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

struct cholmod_factor_struct;

namespace arris {

/// The supernodes of a sparse Cholesky factor L, children before their parents. A supernode is a dense block
/// of consecutive columns that share their rows; its parent has the first row below them as a column.
struct EliminationTree {
    std::vector<int> first_column;  ///< of each supernode; one entry more
    std::vector<int> first_row;     ///< into `rows`; one entry more
    std::vector<int> rows;          ///< of L, ascending; each supernode's own columns first
    std::vector<int> place;         ///< as `rows`: index of the row among the parent's; -1 for own columns
    std::vector<std::ptrdiff_t> first_value;  ///< of L, column-major blocks; one entry more
    std::vector<int> supernode_of;            ///< of each column
    std::vector<int> parent;                  ///< -1 at a root
    std::vector<int> first_child;             ///< into `children`; one entry more
    std::vector<int> children;                ///< ascending

    EliminationTree() = default;
    /// From CHOLMOD's supernodal symbolic factor of a graph of vertices, with three unknowns each.
    explicit EliminationTree(const cholmod_factor_struct& symbolic);

    int size() const { return static_cast<int>(parent.size()); }
    int columns(int node) const { return first_column[node + 1] - first_column[node]; }
    int row_count(int node) const { return first_row[node + 1] - first_row[node]; }
    int below(int node) const { return row_count(node) - columns(node); }
    std::ptrdiff_t value_count() const { return first_value.back(); }
    double flops(int node) const;  ///< of the supernode's partial factorisation
    double flops() const;          ///< of all
};

}  // namespace arris
