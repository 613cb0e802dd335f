// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/sub_mesh.h"

#include <unordered_map>

namespace arris {

SubMesh extract_faces(const ClothMesh& whole, const std::vector<int>& faces)
{
    SubMesh part;
    std::unordered_map<int, int> local;  // never iterated, so that its order does not matter
    for (const int f : faces) {
        Face made;
        for (int i = 0; i < 3; ++i) {
            const int v = whole.faces[f][i];
            const auto [at, is_new] = local.try_emplace(v, static_cast<int>(part.vertices.size()));
            made[i] = at->second;
            if (!is_new) continue;
            part.vertices.push_back(v);
            part.mesh.material.push_back(whole.material[v]);
            part.mesh.world.push_back(whole.world[v]);
        }
        part.mesh.faces.push_back(made);
    }
    return part;
}

}  // namespace arris
