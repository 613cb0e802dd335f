// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

struct cholmod_common_struct;

namespace arris {

enum class VertexOrdering { Metis, NestedDissection, Amd };

/// A fill-reducing elimination order of the scalar unknowns of `matrix` (3n x 3n, lower triangle). Found on
/// the nine times smaller graph of the n vertices, then expanded: the three unknowns of a vertex stay
/// together. A function of the pattern alone. `order[k]` is the unknown eliminated k-th. Throws
/// std::bad_alloc or std::length_error where the graph does not fit.
std::vector<int> order_unknowns(const Eigen::SparseMatrix<double>& matrix, VertexOrdering ordering,
                                cholmod_common_struct& common);

}  // namespace arris
