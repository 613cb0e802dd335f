// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/sewn_vertices.h"

#include "geometry/cloth/mesh_pieces.h"

namespace arris {

std::vector<int> number_vertices(int point_count, const std::vector<std::array<int, 2>>& pairs)
{
    std::vector<Face> joined;
    for (const auto& [p, q] : pairs) joined.push_back({p, q, q});
    std::vector<int> vertex = label_pieces(point_count, joined);  // the first point that each is joined to
    int count = 0;
    for (int p = 0; p < point_count; ++p) vertex[p] = vertex[p] == p ? count++ : vertex[vertex[p]];
    return vertex;
}

}  // namespace arris
