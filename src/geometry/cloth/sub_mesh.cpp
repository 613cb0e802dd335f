// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/sub_mesh.h"

#include <unordered_map>

namespace arris {

namespace {

/// The points of the part's corners, of which each vertex has its first one already.
void add_further_points(const ClothMesh& whole, const std::vector<int>& faces, SubMesh& part)
{
    std::unordered_map<int, int> local;  // as below
    for (std::size_t p = 0; p < part.points.size(); ++p) local[part.points[p]] = static_cast<int>(p);
    for (std::size_t k = 0; k < faces.size(); ++k) {
        Face made;
        for (int i = 0; i < 3; ++i) {
            const int point = whole.points_of(faces[k])[i];
            const auto [at, is_new] = local.try_emplace(point, static_cast<int>(part.points.size()));
            made[i] = at->second;
            if (!is_new) continue;
            part.points.push_back(point);
            part.mesh.material.push_back(whole.material[point]);
            part.mesh.seam_vertices.push_back(part.mesh.faces[k][i]);
        }
        part.mesh.face_points.push_back(made);
    }
}

}  // namespace

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
            part.points.push_back(whole.points_of(f)[i]);
            part.mesh.material.push_back(whole.material[whole.points_of(f)[i]]);
            part.mesh.world.push_back(whole.world[v]);
        }
        part.mesh.faces.push_back(made);
    }
    if (whole.has_seams()) add_further_points(whole, faces, part);
    return part;
}

}  // namespace arris
