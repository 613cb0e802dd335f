// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/sub_mesh.h"

#include <unordered_map>
#include <utility>

namespace arris {

namespace {

/// The points of the part's corners. `points`: the first one of each vertex, which the part has already; of
/// the whole.
void add_further_points(const ClothMesh& whole, const std::vector<int>& faces, std::vector<int> points,
                        ClothMesh& part)
{
    std::unordered_map<int, int> local;  // as below
    for (std::size_t p = 0; p < points.size(); ++p) local[points[p]] = static_cast<int>(p);
    for (std::size_t k = 0; k < faces.size(); ++k) {
        Face made;
        for (int i = 0; i < 3; ++i) {
            const int point = whole.points_of(faces[k])[i];
            const auto [at, is_new] = local.try_emplace(point, static_cast<int>(points.size()));
            made[i] = at->second;
            if (!is_new) continue;
            points.push_back(point);
            part.material.push_back(whole.material[point]);
            part.seam_vertices.push_back(part.faces[k][i]);
        }
        part.face_points.push_back(made);
    }
}

}  // namespace

SubMesh extract_faces(const ClothMesh& whole, const std::vector<int>& faces)
{
    SubMesh part;
    std::vector<int> points;             // of the whole, the first one of each vertex of the part
    std::unordered_map<int, int> local;  // never iterated, so that its order does not matter
    for (const int f : faces) {
        Face made;
        for (int i = 0; i < 3; ++i) {
            const int v = whole.faces[f][i];
            const auto [at, is_new] = local.try_emplace(v, static_cast<int>(part.vertices.size()));
            made[i] = at->second;
            if (!is_new) continue;
            part.vertices.push_back(v);
            points.push_back(whole.points_of(f)[i]);
            part.mesh.material.push_back(whole.material[points.back()]);
            part.mesh.world.push_back(whole.world[v]);
        }
        part.mesh.faces.push_back(made);
    }
    if (whole.has_seams()) add_further_points(whole, faces, std::move(points), part.mesh);
    return part;
}

}  // namespace arris
