// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/normal_cone.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace arris {
namespace {

bool is_solid(const Obstacle& obstacle, int face)
{
    const ObstacleTopology& topology = obstacle.topology();
    return topology.is_solid[topology.component[face]] != 0;
}

Vec3 edge_direction(const Obstacle& obstacle, int edge)
{
    const auto& [a, b] = obstacle.topology().edges[edge].points;
    return (obstacle.mesh().points[b] - obstacle.mesh().points[a]).normalized();
}

double angle_at(const Obstacle& obstacle, int face, int point)
{
    const Face& corners = obstacle.mesh().faces[face];
    const int i = static_cast<int>(std::find(corners.begin(), corners.end(), point) - corners.begin());
    const std::vector<Vec3>& points = obstacle.mesh().points;
    const Vec3 a = points[corners[(i + 1) % 3]] - points[point];
    const Vec3 b = points[corners[(i + 2) % 3]] - points[point];
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The face normal that bounds an edge's cone. On a solid this is the outward normal, on a sheet the normal on
// the side of `direction`.
Vec3 cone_bound(const Obstacle& obstacle, int face, const Vec3& direction)
{
    const Vec3& normal = obstacle.topology().face_normals[face];
    return is_solid(obstacle, face) || normal.dot(direction) >= 0.0 ? normal : Vec3(-normal);
}

}  // namespace

Vec3 into_face(const Obstacle& obstacle, int face, int edge)
{
    const ObstacleTopology& topology = obstacle.topology();
    const std::array<int, 3>& edges = topology.face_edges[face];
    const int i = static_cast<int>(std::find(edges.begin(), edges.end(), edge) - edges.begin());
    const Face& corners = obstacle.mesh().faces[face];
    const Vec3 along = obstacle.mesh().points[corners[(i + 1) % 3]] - obstacle.mesh().points[corners[i]];
    return topology.face_normals[face].cross(along.normalized());
}

bool is_in_edge_cone(const Obstacle& obstacle, int edge, const Vec3& direction)
{
    const std::array<int, 2>& faces = obstacle.topology().edges[edge].faces;
    for (const int f : faces)
        if (f >= 0 && !(into_face(obstacle, f, edge).dot(direction) <= kConeTolerance)) return false;
    if (faces[1] < 0 || !is_solid(obstacle, faces[0])) return true;
    return outward_of_edge(obstacle, edge).dot(direction) > 0.0;
}

bool is_in_point_cone(const Obstacle& obstacle, int point, const Vec3& direction)
{
    const ObstacleTopology& topology = obstacle.topology();
    bool is_on_solids = topology.edge_count_at(point) > 0;
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const ObstacleEdge& edge = topology.edges[topology.edge_at(point, k)];
        const int other = edge.points[0] == point ? edge.points[1] : edge.points[0];
        const Vec3 away = (obstacle.mesh().points[other] - obstacle.mesh().points[point]).normalized();
        if (!(away.dot(direction) <= kConeTolerance)) return false;
        is_on_solids = is_on_solids && edge.faces[0] >= 0 && is_solid(obstacle, edge.faces[0]);
    }
    return !is_on_solids || outward_of_point(obstacle, point).dot(direction) > 0.0;
}

Vec3 clamp_to_edge_cone(const Obstacle& obstacle, int edge, const Vec3& direction)
{
    const Vec3 along = edge_direction(obstacle, edge);
    const Vec3 across = (direction - along.dot(direction) * along).normalized();
    const std::array<int, 2>& faces = obstacle.topology().edges[edge].faces;
    if (faces[0] < 0) return across;
    const Vec3 into_first = into_face(obstacle, faces[0], edge);
    if (faces[1] < 0) return into_first.dot(across) <= 0.0 ? across : cone_bound(obstacle, faces[0], across);
    const Vec3 into_second = into_face(obstacle, faces[1], edge);
    if (into_first.dot(across) <= 0.0 && into_second.dot(across) <= 0.0) return across;
    const Vec3 first = cone_bound(obstacle, faces[0], across);
    const Vec3 second = cone_bound(obstacle, faces[1], across);
    return first.dot(across) >= second.dot(across) ? first : second;
}

Vec3 face_normal_towards(const Obstacle& obstacle, int point, const Vec3& from)
{
    const ObstacleTopology& topology = obstacle.topology();
    Vec3 highest = Vec3::Zero();
    double height = 0.0;
    for (int k = 0; k < topology.edge_count_at(point); ++k)
        for (const int f : topology.edges[topology.edge_at(point, k)].faces) {
            if (f < 0 || !is_solid(obstacle, f) || !(topology.face_normals[f].dot(from) > height)) continue;
            highest = topology.face_normals[f];
            height = highest.dot(from);
        }
    return highest;
}

Vec3 outward_of_edge(const Obstacle& obstacle, int edge)
{
    const std::array<int, 2>& faces = obstacle.topology().edges[edge].faces;
    if (faces[0] < 0) return Vec3::Zero();
    if (faces[1] < 0) return -into_face(obstacle, faces[0], edge);
    return obstacle.topology().face_normals[faces[0]] + obstacle.topology().face_normals[faces[1]];
}

Vec3 outward_of_point(const Obstacle& obstacle, int point)
{
    const ObstacleTopology& topology = obstacle.topology();
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < topology.edge_count_at(point); ++k)
        for (const int f : topology.edges[topology.edge_at(point, k)].faces)
            if (f >= 0) sum += angle_at(obstacle, f, point) * topology.face_normals[f];  // each face twice
    return sum;
}

}  // namespace arris
