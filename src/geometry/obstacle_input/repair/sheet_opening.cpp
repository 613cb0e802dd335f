// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/sheet_opening.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace arris {
namespace {

/// Clears `is_open` along the loop of border edges connected to `first`.
void close_loop(const ObstacleTopology& topology, int first, std::vector<char>& is_open)
{
    std::vector<int> next = {first};
    is_open[first] = 0;
    while (!next.empty()) {
        const int e = next.back();
        next.pop_back();
        for (const int p : topology.edges[e].points)
            for (int k = 0; k < topology.edge_count_at(p); ++k)
                if (const int other = topology.edge_at(p, k); std::exchange(is_open[other], 0))
                    next.push_back(other);
    }
}

double area_of(const ObstacleMesh& mesh, std::size_t face)
{
    const auto& [a, b, c] = mesh.faces[face];
    return 0.5 * (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
}

// A border edge as its face runs along it, and the face's third corner.
struct BorderSide {
    Vec3 from, to, across;
};

BorderSide border_side(const ObstacleMesh& mesh, const ObstacleTopology& topology, int edge)
{
    const int f = topology.edges[edge].faces[0];
    const Face& face = mesh.faces[f];
    int k = 0;
    while (k < 2 && topology.face_edges[f][k] != edge) ++k;
    return {mesh.points[face[k]], mesh.points[face[(k + 1) % 3]], mesh.points[face[(k + 2) % 3]]};
}

/// Angle, degrees, between the face beside a border edge and a lid with the normal `lid`.
double lid_angle(const BorderSide& side, const Vec3& lid)
{
    const Vec3 along = (side.to - side.from).stableNormalized();
    const Vec3 into_lid = lid.cross(along).stableNormalized();
    Vec3 into_face = side.across - side.from;
    into_face -= into_face.dot(along) * along;
    const double cosine = into_lid.dot(into_face.stableNormalized());
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / M_PI;
}

void measure_lids(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                  const std::vector<char>& is_border, std::vector<SheetOpening>& all)
{
    // Newell's sum, about a point of the sheet. Of a sheet with one loop it is the lid's area.
    std::vector<Vec3> lids(all.size(), Vec3::Zero()), origins(all.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        origins[topology.component[f]] = mesh.points[mesh.faces[f][0]];
    for (std::size_t e = 0; e < is_border.size(); ++e) {
        if (!is_border[e]) continue;
        const int sheet = topology.component[topology.edges[e].faces[0]];
        const BorderSide side = border_side(mesh, topology, static_cast<int>(e));
        lids[sheet] += (side.from - origins[sheet]).cross(side.to - origins[sheet]);
    }
    for (Vec3& lid : lids) lid.stableNormalize();
    constexpr double kUpright = 0.087;  // sine of 5 degrees
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const int sheet = topology.component[f];
        const double cosine = std::abs(topology.face_normals[f].dot(lids[sheet]));
        const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        if (std::min(cosine, sine) < kUpright) all[sheet].upright_area += area_of(mesh, f);
    }
    for (std::size_t e = 0; e < is_border.size(); ++e) {
        if (!is_border[e]) continue;
        const int sheet = topology.component[topology.edges[e].faces[0]];
        const double angle = lid_angle(border_side(mesh, topology, static_cast<int>(e)), lids[sheet]);
        all[sheet].least_lid_angle = std::min(all[sheet].least_lid_angle, angle);
    }
}

}  // namespace

std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology)
{
    std::vector<SheetOpening> all(topology.is_solid.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) all[topology.component[f]].area += area_of(mesh, f);
    std::vector<char> is_open(topology.edges.size(), 0);
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const auto& [points, faces] = topology.edges[e];
        if (faces[1] >= 0) continue;
        is_open[e] = 1;
        SheetOpening& opening = all[topology.component[faces[0]]];
        ++opening.border_edges;
        opening.border_length += (mesh.points[points[1]] - mesh.points[points[0]]).norm();
    }
    measure_lids(mesh, topology, is_open, all);
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        if (!is_open[e]) continue;
        close_loop(topology, e, is_open);
        ++all[topology.component[topology.edges[e].faces[0]]].loops;
    }
    std::vector<SheetOpening> openings;
    for (std::size_t c = 0; c < all.size(); ++c)
        if (!topology.is_solid[c]) openings.push_back(all[c]);
    return openings;
}

}  // namespace arris
