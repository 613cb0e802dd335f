// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/collision_mesh.h"

#include <algorithm>
#include <numeric>

namespace arris {

CollisionMesh::CollisionMesh(const ClothMesh& mesh, const UntangleRequest& request)
    : positions(mesh.world),
      cloth_faces_(mesh.face_count()),
      cloth_vertices_(mesh.vertex_count()),
      may_move_(mesh.world.size(), 1),
      is_solid_(mesh.faces.size(), 0),
      self_(request.self)
{
    std::vector<Face> faces = mesh.faces;
    for (const StartObstacle& obstacle : request.obstacles) {
        const int first = static_cast<int>(positions.size());
        const ObstacleMesh& shape = obstacle.pose->mesh();
        const ObstacleTopology& topology = obstacle.pose->topology();
        for (const Vec3& point : shape.points) positions.push_back(obstacle.pose.placement(point));
        poses_.push_back(obstacle.pose);
        rules_.push_back(obstacle.rule);
        first_face_.push_back(static_cast<int>(faces.size()));
        for (std::size_t f = 0; f < shape.faces.size(); ++f) {
            const auto& [a, b, c] = shape.faces[f];
            faces.push_back({first + a, first + b, first + c});
            is_solid_.push_back(topology.is_solid[topology.component[f]]);
        }
    }
    first_face_.push_back(static_cast<int>(faces.size()));
    may_move_.resize(positions.size(), 0);
    for (const int v : request.held) may_move_[v] = 0;
    const int count = static_cast<int>(positions.size());
    surface_ = SelfSurface(count, faces, make_topology(count, faces));
    // Edges ascend by (a, b): a vertex first comes as their end b, with ascending a, and then as their a.
    first_neighbour_.assign(count + 1, 0);
    for (const MeshEdge& edge : surface_.edges)
        for (const int v : {edge.a, edge.b}) ++first_neighbour_[v + 1];
    std::partial_sum(first_neighbour_.begin(), first_neighbour_.end(), first_neighbour_.begin());
    neighbours_.resize(first_neighbour_.back());
    std::vector<int> next(first_neighbour_.begin(), first_neighbour_.end() - 1);
    for (const MeshEdge& edge : surface_.edges) {
        neighbours_[next[edge.a]++] = edge.b;
        neighbours_[next[edge.b]++] = edge.a;
    }
}

CrossingPair CollisionMesh::name(const std::array<int, 2>& pair) const
{
    const int other = pair[1];
    if (is_cloth(other)) return {pair[0], -1, other};
    const auto next = std::upper_bound(first_face_.begin(), first_face_.end(), other);
    const int obstacle = static_cast<int>(next - first_face_.begin()) - 1;
    return {pair[0], obstacle, other - first_face_[obstacle]};
}

int CollisionMesh::find_nearest_face(const Vec3& place, int face) const
{
    const int obstacle = name({0, face}).obstacle;
    const ObstaclePose& pose = poses_[obstacle];
    const Vec3 local = pose.placement.inverse(place);
    // No part of the obstacle is farther than its box is wide, measured from any of its points.
    const double most = (local - pose->mesh().points.front()).norm() + pose->bounds().diagonal().norm();
    const int found = pose->find_nearest_face(local, most);
    return found < 0 ? face : first_face_[obstacle] + found;
}

StartRule CollisionMesh::rule(int first, int second) const
{
    if (is_cloth(first) && is_cloth(second)) return self_;
    if (!is_cloth(first) && !is_cloth(second)) return StartRule::Ignore;
    return rules_[name({std::min(first, second), std::max(first, second)}).obstacle];
}

}  // namespace arris
