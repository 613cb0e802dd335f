// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/sewing.h"

#include <cmath>
#include <utility>

#include "geometry/cloth/mesh_pieces.h"

namespace arris {

namespace {

Face map(const Face& face, const std::vector<int>& to)
{
    return {to[face[0]], to[face[1]], to[face[2]]};
}

}  // namespace

std::vector<int> number_vertices(int point_count, const std::vector<std::array<int, 2>>& pairs)
{
    std::vector<Face> joined;
    for (const auto& [p, q] : pairs) joined.push_back({p, q, q});
    std::vector<int> vertex = label_pieces(point_count, joined);  // the first point that each is joined to
    int count = 0;
    for (int p = 0; p < point_count; ++p) vertex[p] = vertex[p] == p ? count++ : vertex[vertex[p]];
    return vertex;
}

ClothMesh sew(ClothMesh parts, const std::vector<int>& vertex_of)
{
    ClothMesh sewn;
    std::vector<int> first, further;  // points
    for (int p = 0; p < parts.vertex_count(); ++p)
        (vertex_of[p] == static_cast<int>(first.size()) ? first : further).push_back(p);
    if (further.empty()) return parts;
    std::vector<int> name(parts.world.size());
    for (std::size_t v = 0; v < first.size(); ++v) {
        name[first[v]] = static_cast<int>(v);
        sewn.material.push_back(parts.material[first[v]]);
        sewn.world.push_back(parts.world[first[v]]);
    }
    for (const int p : further) {
        name[p] = static_cast<int>(sewn.material.size());
        sewn.material.push_back(parts.material[p]);
        sewn.seam_vertices.push_back(vertex_of[p]);
    }
    for (const Face& face : parts.faces) {
        sewn.faces.push_back(map(face, vertex_of));
        sewn.face_points.push_back(map(face, name));
    }
    return sewn;
}

ClothMesh unsew(ClothMesh mesh)
{
    if (!mesh.has_seams()) return mesh;
    for (const int v : mesh.seam_vertices) mesh.world.push_back(mesh.world[v]);
    return {std::move(mesh.material), std::move(mesh.world), std::move(mesh.face_points)};
}

bool has_one_share(double before, double after, double other_before, double other_after)
{
    constexpr double kRounding = 1e-3;
    return std::abs(before / (before + after) - other_before / (other_before + other_after)) < kRounding;
}

ClothMesh join(const std::vector<ClothMesh>& meshes)
{
    if (meshes.size() == 1) return meshes.front();
    ClothMesh all;
    bool has_seams = false;
    for (const ClothMesh& mesh : meshes) {
        const int first = all.vertex_count();
        all.material.insert(all.material.end(), mesh.material.begin(),
                            mesh.material.begin() + mesh.vertex_count());
        all.world.insert(all.world.end(), mesh.world.begin(), mesh.world.end());
        for (const auto& [a, b, c] : mesh.faces) all.faces.push_back({a + first, b + first, c + first});
        has_seams |= mesh.has_seams();
    }
    if (!has_seams) return all;
    int first = 0;
    for (const ClothMesh& mesh : meshes) {
        const int further = static_cast<int>(all.material.size()), own = mesh.vertex_count();
        all.material.insert(all.material.end(), mesh.material.begin() + own, mesh.material.end());
        for (const int v : mesh.seam_vertices) all.seam_vertices.push_back(v + first);
        for (int f = 0; f < mesh.face_count(); ++f) {
            Face points = mesh.points_of(f);
            for (int& p : points) p = p < own ? p + first : p - own + further;
            all.face_points.push_back(points);
        }
        first += own;
    }
    return all;
}

}  // namespace arris
