// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/elimination_tree.h"

#include <cholmod.h>

#include <cassert>
#include <numeric>

namespace arris {
namespace {

/// Each entry as three unknowns of a vertex.
std::vector<int> unknowns_of(const int* vertices, std::size_t count)
{
    std::vector<int> unknowns;
    unknowns.reserve(3 * count);
    for (std::size_t k = 0; k < count; ++k)
        for (int axis = 0; axis < 3; ++axis) unknowns.push_back(3 * vertices[k] + axis);
    return unknowns;
}

std::vector<int> three_times(const int* values, std::size_t count)
{
    std::vector<int> result(values, values + count);
    for (int& value : result) value *= 3;
    return result;
}

}  // namespace

EliminationTree::EliminationTree(const cholmod_factor_struct& symbolic)
    : first_column(three_times(static_cast<const int*>(symbolic.super), symbolic.nsuper + 1)),
      first_row(three_times(static_cast<const int*>(symbolic.pi), symbolic.nsuper + 1)),
      rows(unknowns_of(static_cast<const int*>(symbolic.s), symbolic.ssize)),
      place(rows.size(), -1),
      first_value(symbolic.nsuper + 1, 0),
      supernode_of(3 * symbolic.n),
      parent(symbolic.nsuper, -1),
      first_child(symbolic.nsuper + 1, 0)
{
    for (int s = 0; s < size(); ++s) {
        for (int k = first_column[s]; k < first_column[s + 1]; ++k) supernode_of[k] = s;
        first_value[s + 1] = first_value[s] + static_cast<std::ptrdiff_t>(columns(s)) * row_count(s);
    }
    for (int s = 0; s < size(); ++s) {
        if (below(s) == 0) continue;
        const int first = first_row[s] + columns(s), above = parent[s] = supernode_of[rows[first]];
        int at = first_row[above];
        for (int r = first; r < first_row[s + 1]; ++r) {
            while (rows[at] != rows[r]) ++at;  // a supernode's rows are among its parent's
            assert(at < first_row[above + 1]);
            place[r] = at - first_row[above];
        }
        ++first_child[above + 1];
    }
    std::partial_sum(first_child.begin(), first_child.end(), first_child.begin());
    children.resize(static_cast<std::size_t>(first_child.back()));
    std::vector<int> next(first_child.begin(), first_child.end() - 1);
    for (int s = 0; s < size(); ++s)
        if (parent[s] >= 0) children[next[parent[s]]++] = s;
}

double EliminationTree::flops(int node) const
{
    const double own = columns(node), under = below(node);
    return own * (own * own / 3.0 + own * under + under * under);
}

double EliminationTree::flops() const
{
    double sum = 0.0;
    for (int s = 0; s < size(); ++s) sum += flops(s);
    return sum;
}

}  // namespace arris
