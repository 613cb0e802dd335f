// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/euler_characteristic.h"

#include <algorithm>
#include <array>
#include <vector>

namespace arris {

int euler_characteristic(const ClothMesh& mesh)
{
    std::vector<std::array<int, 2>> edges;
    for (const Face& face : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(face[k], face[(k + 1) % 3]);
            edges.push_back({low, high});
        }
    std::sort(edges.begin(), edges.end());
    const auto count = std::unique(edges.begin(), edges.end()) - edges.begin();
    return mesh.vertex_count() - static_cast<int>(count) + mesh.face_count();
}

}  // namespace arris
