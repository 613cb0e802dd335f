// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/face_planes.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace arris {
namespace {

// Single-precision coordinates are rounded by up to 6e-8 of their size. The normal of a sliver lower than a
// few such errors is noise.
constexpr double kThinHeight = 3e-7;  // relative to the bounding box's diagonal
constexpr double kThinAspect = 1e-2;  // relative to the face's longest edge

double side_length(const ObstacleMesh& mesh, int face, int i)
{
    return (mesh.points[mesh.faces[face][(i + 1) % 3]] - mesh.points[mesh.faces[face][i]]).norm();
}

bool is_thin(const ObstacleMesh& mesh, int face, double diagonal)
{
    const auto& [a, b, c] = mesh.faces[face];
    const double length =
        std::max({side_length(mesh, face, 0), side_length(mesh, face, 1), side_length(mesh, face, 2)});
    const Vec3 ab = mesh.points[b] - mesh.points[a], ac = mesh.points[c] - mesh.points[a];
    const double height = (ab / length).cross(ac).norm();
    return height < kThinHeight * diagonal && height < kThinAspect * length;
}

/// The neighbour across the longest side that is no border; -1 where all sides are borders.
int widest_neighbour(const ObstacleMesh& mesh, const ObstacleTopology& topology, int face)
{
    int widest = -1;
    double longest = -1.0;
    for (int i = 0; i < 3; ++i)
        if (topology.neighbour(face, i) >= 0 && side_length(mesh, face, i) > longest) {
            longest = side_length(mesh, face, i);
            widest = topology.neighbour(face, i);
        }
    return widest;
}

}  // namespace

FacePlanes find_planes(const ObstacleMesh& mesh, const ObstacleTopology& topology, double diagonal)
{
    const int n = static_cast<int>(mesh.faces.size());
    std::vector<char> thin(n);
    for (int f = 0; f < n; ++f) thin[f] = is_thin(mesh, f, diagonal);

    FacePlanes planes{topology.face_normals, std::vector<char>(n, 0)};
    constexpr int kMostThinInARow = 64;  // bounds the search, which may run in a circle
    for (int f = 0; f < n; ++f) {
        int from = f;
        for (int k = 0; k < kMostThinInARow && from >= 0 && thin[from]; ++k)
            from = widest_neighbour(mesh, topology, from);
        if (from < 0 || from == f || thin[from]) continue;
        planes.normals[f] = topology.face_normals[from];
        planes.is_borrowed[f] = 1;
    }
    return planes;
}

double diagonal_of(const ObstacleMesh& mesh)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh.points) box.extend(p);
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace arris
