// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/contact/obstacle_contact.h"

// Cloths and obstacles to make contacts of, and what is true of distances by brute force.
namespace arris::samples {

/// A cloth's way with the mesh it refers to; not to be moved.
struct ClothWay {
    ClothWay(std::vector<Vec3> begin, std::vector<Vec3> end, std::vector<Face> triangles);
    ClothWay(const ClothWay&) = delete;
    ClothWay& operator=(const ClothWay&) = delete;

    std::vector<Face> faces;
    std::vector<MeshEdge> edges;
    ClothMotion motion;
};

/// Vertices without faces: motion of points.
ClothMotion points_way(std::vector<Vec3> begin, std::vector<Vec3> end);

/// Triangles of a grid of nx x ny cells whose vertex (i, j) is i + j (nx + 1).
std::vector<Face> grid_faces(int nx, int ny);

/// Vertices of that grid: origin + i u + j v.
std::vector<Vec3> grid_points(int nx, int ny, const Vec3& origin, const Vec3& u, const Vec3& v);

std::vector<Vec3> shifted(std::vector<Vec3> points, const Vec3& by);

Obstacle make_obstacle(ObstacleMesh mesh, double feature_angle = 30.0);

/// Nearest point of faces, segments and lone points.
Vec3 nearest_point(const ObstacleMesh& mesh, const Vec3& place);

/// Whether `point`, on the mesh, is nearest to `place` on every face and segment and lone point that has it:
/// a local minimum of the distance. `tolerance` is a sine.
bool is_local_minimum(const ObstacleMesh& mesh, const Vec3& point, const Vec3& place, double tolerance);

/// Whether a place is inside a closed mesh: crossings of a ray in a fixed, odd direction.
bool is_inside(const ObstacleMesh& mesh, const Vec3& place);

/// normal . (sum w x - point) of a contact.
double gap_of(const ObstacleContact& contact, const std::vector<Vec3>& positions);

}  // namespace arris::samples
