// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/mesh_pieces.h"

#include <algorithm>
#include <numeric>

namespace arris {

std::vector<int> label_pieces(int vertex_count, const std::vector<Face>& faces)
{
    std::vector<int> piece(vertex_count);
    std::iota(piece.begin(), piece.end(), 0);
    const auto root = [&](int v) {
        while (piece[v] != v) v = piece[v] = piece[piece[v]];
        return v;
    };
    for (const Face& face : faces)
        for (const int k : {1, 2}) {
            const int a = root(face[0]), b = root(face[k]);
            piece[std::max(a, b)] = std::min(a, b);
        }
    for (int v = 0; v < vertex_count; ++v) piece[v] = root(v);
    return piece;
}

}  // namespace arris
