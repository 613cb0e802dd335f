// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/vertex_ordering.h"

#include <cholmod.h>

#include <cassert>
#include <csignal>
#include <new>
#include <stdexcept>

namespace arris {
namespace {

struct VertexGraph {
    std::vector<int> start = {0};
    std::vector<int> neighbour;  ///< i >= j of column j
};

VertexGraph vertex_graph(const Eigen::SparseMatrix<double>& matrix)
{
    const int vertices = static_cast<int>(matrix.cols()) / 3;
    VertexGraph graph;
    std::vector<int> seen_by(static_cast<std::size_t>(vertices), -1);
    for (int column = 0; column < vertices; ++column) {
        for (int unknown = 3 * column; unknown < 3 * column + 3; ++unknown)
            for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, unknown); entry; ++entry) {
                const int vertex = static_cast<int>(entry.row()) / 3;
                if (vertex < column || seen_by[vertex] == column) continue;
                seen_by[vertex] = column;
                graph.neighbour.push_back(vertex);
            }
        graph.start.push_back(static_cast<int>(graph.neighbour.size()));
    }
    return graph;
}

cholmod_sparse view(VertexGraph& graph)
{
    cholmod_sparse sparse = {};
    sparse.nrow = sparse.ncol = graph.start.size() - 1;
    sparse.nzmax = graph.neighbour.size();
    sparse.p = graph.start.data();
    sparse.i = graph.neighbour.data();
    sparse.stype = -1;
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = CHOLMOD_PATTERN;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.packed = 1;
    return sparse;
}

/// METIS handles SIGTERM itself while it works, and then returns an error status without a reason. The signal
/// was meant for the program: it is raised again, and METIS runs once more.
bool order_by_metis(cholmod_sparse& graph, std::vector<int>& vertices, cholmod_common& common)
{
    const auto has_ordered = [&] {
        return cholmod_metis(&graph, nullptr, 0, 1, vertices.data(), &common) != 0;
    };
    if (has_ordered()) return true;
    if (common.status != CHOLMOD_INVALID) return false;
    std::raise(SIGTERM);
    return has_ordered();
}

bool order(cholmod_sparse& graph, VertexOrdering ordering, std::vector<int>& vertices, cholmod_common& common)
{
    std::vector<int> parent(graph.nrow), member(graph.nrow);
    switch (ordering) {
        case VertexOrdering::Metis:
            return order_by_metis(graph, vertices, common);
        case VertexOrdering::NestedDissection:
            return cholmod_nested_dissection(&graph, nullptr, 0, vertices.data(), parent.data(),
                                             member.data(), &common) >= 0;
        case VertexOrdering::Amd:
            return cholmod_amd(&graph, nullptr, 0, vertices.data(), &common) != 0;
    }
    return false;
}

}  // namespace

std::vector<int> order_unknowns(const Eigen::SparseMatrix<double>& matrix, VertexOrdering ordering,
                                cholmod_common& common)
{
    assert(matrix.cols() % 3 == 0 && "three unknowns a vertex");
    VertexGraph graph = vertex_graph(matrix);
    cholmod_sparse pattern = view(graph);
    std::vector<int> vertices(pattern.nrow);
    if (!order(pattern, ordering, vertices, common)) {
        if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
        throw std::length_error("the vertex graph is too large to be ordered");
    }
    std::vector<int> unknowns;
    unknowns.reserve(3 * vertices.size());
    for (const int vertex : vertices)
        for (int axis = 0; axis < 3; ++axis) unknowns.push_back(3 * vertex + axis);
    return unknowns;
}

}  // namespace arris
