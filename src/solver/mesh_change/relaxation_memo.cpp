// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/relaxation_memo.h"

namespace arris {

namespace {

std::vector<double> make_key(const LoosePatch& patch, double drop)
{
    const ClothMesh& mesh = patch.mesh;
    std::vector<double> key = {drop, double(mesh.vertex_count())};
    key.reserve(9 * mesh.world.size() + 3 * mesh.faces.size() + 2 * patch.creases.edges.size() + 3);
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        for (const Vec3* u : {&mesh.world[v], &patch.normals[v]}) key.insert(key.end(), u->begin(), u->end());
        key.insert(key.end(), mesh.material[v].begin(), mesh.material[v].end());
        key.push_back(patch.is_free[v]);
    }
    for (const Face& face : mesh.faces) key.insert(key.end(), face.begin(), face.end());
    key.insert(key.end(), patch.creases.widths.begin(), patch.creases.widths.end());
    for (const auto& edge : patch.creases.edges) key.insert(key.end(), edge.begin(), edge.end());
    return key;
}

}  // namespace

bool RelaxationMemo::can_relax_by(const Scene& scene, const LoosePatch& patch, double drop)
{
    const auto [at, is_new] = known_.try_emplace(make_key(patch, drop));
    if (is_new) at->second = arris::can_relax_by(scene, patch, drop);
    return at->second;
}

}  // namespace arris
