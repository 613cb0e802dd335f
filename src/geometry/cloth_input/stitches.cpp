// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/stitches.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "geometry/input_error.h"

namespace arris {
namespace {

/// Share of an edge within which a stitch ends on its vertex: dividing nearer would make slivers.
constexpr double kNearVertex = 0.25;

using Edge = std::array<int, 2>;  // ascending

/// Divides the faces at an edge, at a point of it. Returns the new vertex.
int divide(int a, int b, double share, ClothMesh& mesh)
{
    const int made = mesh.vertex_count();
    mesh.world.push_back((1.0 - share) * mesh.world[a] + share * mesh.world[b]);
    mesh.material.push_back((1.0 - share) * mesh.material[a] + share * mesh.material[b]);
    for (int f = 0, faces = mesh.face_count(); f < faces; ++f) {
        Face& face = mesh.faces[f];
        for (int k = 0; k < 3; ++k) {
            const int from = face[k], to = face[(k + 1) % 3], apex = face[(k + 2) % 3];
            if (!((from == a && to == b) || (from == b && to == a))) continue;
            face = {from, made, apex};
            mesh.faces.push_back({made, to, apex});
            break;
        }
    }
    return made;
}

/// Whether two vertices are an edge of a face.
bool is_edge(const ClothMesh& mesh, const Edge& edge)
{
    return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& face) {
        return std::count(face.begin(), face.end(), edge[0]) +
                   std::count(face.begin(), face.end(), edge[1]) ==
               2;
    });
}

}  // namespace

std::vector<Stitch> number_stitches(const std::vector<ObjStitch>& stitches, const std::vector<int>& vertices)
{
    std::vector<Stitch> numbered;
    for (const ObjStitch& of : stitches) {
        for (const int v : of.vertices)
            if (v >= static_cast<int>(vertices.size()) || vertices[static_cast<std::size_t>(v)] < 0)
                throw InputError(fmt::format(
                    "line {}: its stitch names vertex {}, which no face has; allowed: 0 to {}, of faces",
                    of.line, v, static_cast<int>(vertices.size()) - 1));
        const auto vertex = [&](int k) { return vertices[static_cast<std::size_t>(of.vertices[k])]; };
        numbered.push_back({vertex(0), vertex(1), vertex(2), of.share, of.line});
    }
    return numbered;
}

std::vector<std::array<int, 2>> divide_at_stitches(const std::vector<Stitch>& stitches, ClothMesh& mesh)
{
    std::vector<std::array<int, 2>> pairs(stitches.size());
    std::map<Edge, std::vector<std::pair<double, std::size_t>>> inside;  // shares from the lesser vertex
    for (std::size_t s = 0; s < stitches.size(); ++s) {
        const Stitch& stitch = stitches[s];
        const bool is_at_begin =
            stitch.share<(mesh.has_seams() ? 0.5 : kNearVertex), is_at_end = stitch.share>(
                mesh.has_seams() ? 0.5 : 1.0 - kNearVertex);
        pairs[s] = {stitch.vertex, is_at_end ? stitch.end : stitch.begin};
        if (stitch.begin == stitch.end || is_at_begin || is_at_end || mesh.has_seams()) continue;
        const bool is_forward = stitch.begin < stitch.end;
        inside[{std::min(stitch.begin, stitch.end), std::max(stitch.begin, stitch.end)}].push_back(
            {is_forward ? stitch.share : 1.0 - stitch.share, s});
    }
    for (auto& [edge, shares] : inside) {
        if (!is_edge(mesh, edge))
            throw InputError(fmt::format(
                "line {}: its stitch ends between two vertices that are no edge of a face; allowed: the two "
                "ends of an edge, or one vertex twice",
                stitches[shares.front().second].line));
        std::sort(shares.begin(), shares.end());
        int last = edge[0];
        double at = 0.0;
        for (const auto& [share, s] : shares) {
            if (last == edge[0] || share - at > kNearVertex) {
                last = divide(last, edge[1], (share - at) / (1.0 - at), mesh);
                at = share;
            }
            pairs[s][1] = last;
        }
    }
    std::erase_if(pairs, [](const auto& pair) { return pair[0] == pair[1]; });
    return pairs;
}

}  // namespace arris
