// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/self_contact/self_surface.h"
#include "geometry/untangle/untangle.h"

namespace arris {

/// The cloth and all obstacles as one mesh in the world, so that one piece of code untangles the cloth from
/// both. The cloth's vertices and faces come first, with their own indices. Wires and points of obstacles are
/// left out.
class CollisionMesh {
  public:
    CollisionMesh(const ClothMesh& mesh, const UntangleRequest& request);

    const SelfSurface& surface() const { return surface_; }
    int cloth_faces() const { return cloth_faces_; }
    int cloth_vertices() const { return cloth_vertices_; }
    bool is_cloth(int face) const { return face < cloth_faces_; }
    bool may_move(int vertex) const { return may_move_[vertex]; }
    /// Vertices that edges join to a vertex, ascending.
    std::span<const int> neighbours(int vertex) const
    {
        return {neighbours_.data() + first_neighbour_[vertex],
                neighbours_.data() + first_neighbour_[vertex + 1]};
    }
    /// Whether a face belongs to the closed surface of an obstacle, with its normal outward.
    bool is_solid(int face) const { return is_solid_[face]; }
    /// How two faces are to be treated; two of obstacles may cross.
    StartRule rule(int first, int second) const;
    /// The face of the obstacle of `face` that is nearest to a place in the world.
    int find_nearest_face(const Vec3& place, int face) const;
    CrossingPair name(const std::array<int, 2>& pair) const;

    std::vector<Vec3> positions;

  private:
    int cloth_faces_, cloth_vertices_;
    SelfSurface surface_;
    std::vector<int> first_neighbour_, neighbours_;  // of each vertex, and the end
    std::vector<char> may_move_, is_solid_;
    StartRule self_;
    std::vector<ObstaclePose> poses_;  // of the obstacles
    std::vector<StartRule> rules_;     // of the obstacles
    std::vector<int> first_face_;      // of each obstacle, and the end
};

}  // namespace arris
