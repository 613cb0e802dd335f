// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/stitches.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/input_error.h"

namespace arris {
namespace {

/// Share of an edge within which a stitch ends on its vertex: dividing nearer would make slivers.
constexpr double kNearVertex = 0.25;

using Edge = std::array<int, 2>;  // ascending

Edge edge_of(int a, int b)
{
    return {std::min(a, b), std::max(a, b)};
}

/// A mesh whose edges are divided.
class EdgeDivision {
  public:
    explicit EdgeDivision(ClothMesh& mesh) : mesh_(mesh)
    {
        for (int f = 0; f < mesh.face_count(); ++f)
            for (int k = 0; k < 3; ++k) faces_of(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]).push_back(f);
    }

    bool has(const Edge& edge) const { return faces_of_.contains(edge); }

    /// Divides the faces at an edge, at a point of it. Returns the new vertex.
    int divide(int a, int b, double share)
    {
        const int made = mesh_.vertex_count();
        mesh_.world.push_back((1.0 - share) * mesh_.world[a] + share * mesh_.world[b]);
        mesh_.material.push_back((1.0 - share) * mesh_.material[a] + share * mesh_.material[b]);
        const std::vector<int> faces = std::exchange(faces_of(a, b), {});
        faces_of_.erase(edge_of(a, b));
        for (const int f : faces) {
            const Face face = mesh_.faces[f];
            const auto k = static_cast<std::size_t>(
                std::find_if(face.begin(), face.end(), [&](int v) { return v != a && v != b; }) -
                face.begin());
            const int apex = face[k], from = face[(k + 1) % 3], to = face[(k + 2) % 3];
            const int added = mesh_.face_count();
            mesh_.faces[f] = {from, made, apex};
            mesh_.faces.push_back({made, to, apex});
            std::vector<int>& beyond = faces_of(to, apex);
            std::replace(beyond.begin(), beyond.end(), f, added);
            faces_of(from, made).push_back(f);
            faces_of(made, to).push_back(added);
            faces_of(made, apex) = {f, added};
        }
        return made;
    }

  private:
    std::vector<int>& faces_of(int a, int b) { return faces_of_[edge_of(a, b)]; }

    ClothMesh& mesh_;
    std::map<Edge, std::vector<int>> faces_of_;
};

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
        const double near = mesh.has_seams() ? 0.5 : kNearVertex;
        const bool is_at_begin = stitch.share < near;
        const bool is_at_end = stitch.share > 1.0 - near;
        pairs[s] = {stitch.vertex, is_at_end ? stitch.end : stitch.begin};
        if (stitch.begin == stitch.end || is_at_begin || is_at_end || mesh.has_seams()) continue;
        const bool is_forward = stitch.begin < stitch.end;
        inside[edge_of(stitch.begin, stitch.end)].push_back(
            {is_forward ? stitch.share : 1.0 - stitch.share, s});
    }
    EdgeDivision division(mesh);
    for (auto& [edge, shares] : inside) {
        if (!division.has(edge))
            throw InputError(fmt::format(
                "line {}: its stitch ends between two vertices that are no edge of a face; allowed: the two "
                "ends of an edge, or one vertex twice",
                stitches[shares.front().second].line));
        std::sort(shares.begin(), shares.end());
        int last = edge[0];
        double at = 0.0;
        for (const auto& [share, s] : shares) {
            if (last == edge[0] || share - at > kNearVertex) {
                last = division.divide(last, edge[1], (share - at) / (1.0 - at));
                at = share;
            }
            pairs[s][1] = last;
        }
    }
    std::erase_if(pairs, [](const auto& pair) { return pair[0] == pair[1]; });
    return pairs;
}

}  // namespace arris
