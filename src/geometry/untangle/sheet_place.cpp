// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/sheet_place.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace arris {

Vec3 normal_of(const CollisionMesh& mesh, int face)
{
    const std::vector<Vec3>& x = mesh.positions;
    const auto& [a, b, c] = mesh.surface().faces[face];
    return (x[b] - x[a]).stableNormalized().cross((x[c] - x[a]).stableNormalized()).stableNormalized();
}

PointOnTriangle nearest_on(const CollisionMesh& mesh, const Vec3& place, int face)
{
    const std::vector<Vec3>& x = mesh.positions;
    const auto& [a, b, c] = mesh.surface().faces[face];
    return closest_on_triangle(place, {x[a], x[b], x[c]}, normal_of(mesh, face));
}

namespace {

/// The other faces that hold a point on a face's edge or corner.
std::vector<int> others_at(const SelfSurface& surface, int face, const PointOnTriangle& at)
{
    std::vector<int> others;
    if (at.edge >= 0) {
        const MeshEdge& edge = surface.edges[surface.edges_of[face][at.edge]];
        const int across = edge.face_left == face ? edge.face_right : edge.face_left;
        if (across >= 0) others.push_back(across);
    } else if (at.corner >= 0) {
        for (const int f : surface.faces_at[surface.faces[face][at.corner]])
            if (f != face) others.push_back(f);
    }
    return others;
}

bool is_on_border(const SelfSurface& surface, int face, const PointOnTriangle& at)
{
    if (at.edge >= 0) return surface.edges[surface.edges_of[face][at.edge]].face_right < 0;
    if (at.corner < 0) return false;
    const int v = surface.faces[face][at.corner];
    for (const int f : surface.faces_at[v])
        for (const int e : surface.edges_of[f]) {
            const MeshEdge& edge = surface.edges[e];
            if (edge.face_right < 0 && (edge.a == v || edge.b == v)) return true;
        }
    return false;
}

}  // namespace

SheetPlace walk_to_nearest(const CollisionMesh& mesh, const Vec3& place, int face)
{
    const SelfSurface& surface = mesh.surface();
    if (mesh.is_solid(face)) face = mesh.find_nearest_face(place, face);
    PointOnTriangle at = nearest_on(mesh, place, face);
    double least = (place - at.point).squaredNorm();
    // Each step is nearer than the one before, so no face comes twice.
    for (std::size_t step = 0; step < surface.faces.size(); ++step) {
        int next = -1;
        PointOnTriangle nearest = at;
        for (const int f : others_at(surface, face, at)) {
            const PointOnTriangle found = nearest_on(mesh, place, f);
            const double squared = (place - found.point).squaredNorm();
            if (squared >= least) continue;
            least = squared;
            next = f;
            nearest = found;
        }
        if (next < 0) break;
        face = next;
        at = nearest;
    }
    Vec3 normal = normal_of(mesh, face);
    for (const int f : others_at(surface, face, at)) normal += normal_of(mesh, f);
    return {face,
            at.weights,
            at.point,
            normal.stableNormalized(),
            std::sqrt(least),
            is_on_border(surface, face, at)};
}

}  // namespace arris
