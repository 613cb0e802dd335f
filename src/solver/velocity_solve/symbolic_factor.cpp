// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/symbolic_factor.h"

#include <cholmod.h>

#include <algorithm>
#include <numeric>

namespace arris {

SymbolicFactor::SymbolicFactor(const Eigen::SparseMatrix<double>& matrix, const VertexGraph& graph,
                               const cholmod_factor& of_vertices)
    : tree(of_vertices),
      walk(tree),
      updates(tree, walk),
      position(static_cast<std::size_t>(matrix.cols())),
      first_block(static_cast<std::size_t>(tree.size()) + 1, 0),
      blocks(graph.neighbour.size()),
      flops(tree.flops())
{
    // CHOLMOD applies a postorder of the elimination tree to the given order: the order of the factor counts.
    const int* order = static_cast<const int*>(of_vertices.Perm);
    for (int k = 0; k < static_cast<int>(matrix.cols()); ++k) position[3 * order[k / 3] + k % 3] = k;

    const auto for_each_block = [&](const auto& visit) {
        for (int column = 0; column < graph.size(); ++column)
            for (int k = graph.start[column]; k < graph.start[column + 1]; ++k) {
                const int row = graph.neighbour[k];
                visit(tree.supernode_of[std::min(position[3 * row], position[3 * column])], row, column,
                      k - graph.start[column]);
            }
    };
    for_each_block([&](int s, int, int, int) { ++first_block[s + 1]; });
    std::partial_sum(first_block.begin(), first_block.end(), first_block.begin());
    std::vector<int> next(first_block.begin(), first_block.end() - 1);
    const int* outer = matrix.outerIndexPtr();
    for_each_block([&](int s, int row, int column, int k) {
        const int first = 3 * column;
        blocks[next[s]++] = {row,
                             column,
                             outer[first] + 3 * k,
                             outer[first + 1] - outer[first],
                             0,
                             position[3 * row] < position[first]};
    });

    std::vector<int> place(position.size());  // of each row of L in the supernode at hand
    for (int s = 0; s < tree.size(); ++s) {
        const int *rows = tree.rows.data() + tree.first_row[s], count = tree.row_count(s);
        for (int r = 0; r < count; ++r) place[rows[r]] = r;
        for (int k = first_block[s]; k < first_block[s + 1]; ++k) {
            MatrixBlock& block = blocks[k];
            const auto [low, high] = std::minmax(position[3 * block.row], position[3 * block.column]);
            block.target = tree.first_value[s] +
                           static_cast<std::ptrdiff_t>(low - tree.first_column[s]) * count + place[high];
        }
    }
}

}  // namespace arris
