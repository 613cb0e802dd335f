// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/contact/obstacle_contact.h"

// Cloths and obstacles for contact tests, and properties of distances by brute force.
namespace arris::samples {

/// A cloth's motion with the mesh it refers to; the object must not be moved in memory.
struct ClothWay {
    ClothWay(std::vector<Vec3> begin, std::vector<Vec3> end, std::vector<Face> triangles);
    ClothWay(const ClothWay&) = delete;
    ClothWay& operator=(const ClothWay&) = delete;

    std::vector<Face> faces;
    std::vector<MeshEdge> edges;
    ClothMotion motion;
};

/// The motion of vertices without faces.
ClothMotion points_way(std::vector<Vec3> begin, std::vector<Vec3> end);

/// Triangles of a grid of nx x ny cells. Vertex (i, j) has the index i + j (nx + 1).
std::vector<Face> grid_faces(int nx, int ny);

/// Vertices of that grid at origin + i u + j v.
std::vector<Vec3> grid_points(int nx, int ny, const Vec3& origin, const Vec3& u, const Vec3& v);

std::vector<Vec3> shifted(std::vector<Vec3> points, const Vec3& by);

Obstacle make_obstacle(ObstacleMesh mesh, double feature_angle = 30.0);

/// The point of the mesh's faces, segments and lone points that is nearest to a place.
Vec3 nearest_point(const ObstacleMesh& mesh, const Vec3& place);

/// Whether `point` on the mesh is a local minimum of the distance to `place`. It is one if every face,
/// segment and lone point that contains `point` has its nearest point there. `tolerance` is a sine.
bool is_local_minimum(const ObstacleMesh& mesh, const Vec3& point, const Vec3& place, double tolerance);

/// Whether a place is inside a closed mesh, by counting crossings of a ray in a fixed, irregular direction.
bool is_inside(const ObstacleMesh& mesh, const Vec3& place);

/// normal . (sum w x - point) of a contact.
double gap_of(const ObstacleContact& contact, const std::vector<Vec3>& positions);

}  // namespace arris::samples
