// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/self_contact/self_contact.h"
#include "geometry/untangle/ways_apart.h"

namespace arris {

/// Obstructions to a move. Clean: only elements met that may.
struct MoveFinding {
    std::vector<SelfContact> violations;  ///< planes that would have prevented the meetings
    bool is_clean = false;
    Crossings after;  ///< at the move's end; only of a clean move
};

/// Checks moves of the cloth against itself and all obstacles.
class MoveCheck {
  public:
    MoveCheck(const CollisionMesh& mesh, const UntangleRequest& request);

    /// Checks a move from the mesh's positions to `end`. Only the two sides of a way of `ways` may meet, and
    /// may cross at the end; other pairs cross there only if they do so now, by `before`.
    MoveFinding check(const std::vector<Vec3>& end, const std::vector<WayApart>& ways,
                      const Crossings& before) const;

  private:
    /// Wires and points of an obstacle, which make no faces of the mesh.
    struct Wires {
        Obstacle shape;
        Placement placement;
    };
    bool passes_wire(const std::vector<Vec3>& end) const;
    bool may_meet(SelfContactKind kind, int first, int second, const WaySides& sides) const;

    const CollisionMesh& mesh_;
    double thickness_;
    std::vector<Wires> wires_;
    std::vector<Face> cloth_;  // its faces and edges
    std::vector<MeshEdge> edges_;
};

}  // namespace arris
