// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/sewn_vertices.h"

#include <numeric>

namespace arris {

std::vector<int> number_vertices(int point_count, const std::vector<std::array<int, 2>>& pairs)
{
    // Union-find; the root is the first point.
    std::vector<int> parent(point_count);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int p) {
        while (parent[p] != p) p = parent[p] = parent[parent[p]];
        return p;
    };
    for (const auto& [p, q] : pairs) {
        const int a = root(p), b = root(q);
        parent[a < b ? b : a] = a < b ? a : b;
    }
    std::vector<int> vertex(point_count);
    int count = 0;
    for (int p = 0; p < point_count; ++p) vertex[p] = parent[p] == p ? count++ : vertex[root(p)];
    return vertex;
}

}  // namespace arris
