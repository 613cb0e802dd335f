// SPDX-License-Identifier: GPL-3.0-or-later
// Velocity coordinates of EOL vertices. Such a vertex has three unknowns, as any other: c away from the
// feature, a along it, and the material's flow s over it. At a corner or a bend of a wire these are c and two
// components of flow. Contact is then the bound c >= .... The system stays positive definite in flat cloth,
// where motion across the feature in the world and in the material are one and the same.
#pragma once

#include <optional>
#include <vector>

#include "geometry/obstacle/feature_frame.h"
#include "geometry/obstacle/moving_obstacle.h"
#include "geometry/rigid_motion.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/constraint_cause.h"
#include "solver/model/state.h"

namespace arris {

/// A further point of a vertex on a seam, through which material flows as `turn` times the flow at the first.
struct SeamPoint {
    int point;
    Mat2 turn;
};

/// One EOL vertex during a step: xdot = drift + basis u, Xdot = material_basis u, u = (c, a, s) or
/// (c, s1, s2).
struct EolCoordinates {
    int vertex;
    int entry;           ///< index in State::eol
    FeatureFrame frame;  ///< at the step's start, in the obstacle's frame
    Vec3 carried;        ///< its place at the step's end if it rides on the obstacle, world
    Mat3 basis;          ///< first column: the outward direction at the step's end
    Mat23 material_basis;
    int side;                   ///< new value of EolVertex::side
    Vec3 opening;               ///< change of u, (1, ...), that opens the gap with the least kinetic energy
    Vec2 trace = Vec2::Zero();  ///< direction of the feature in the material, as its tangent; zero at corners
    std::vector<SeamPoint> beyond = {};  ///< the vertex's points on the other side of a seam

    /// Calls `visit(point, V)` for each point of the vertex, with its part of a flow V at the first one.
    template <typename Visit>
    void for_points(const Vec2& flow, const Visit& visit) const
    {
        visit(vertex, flow);
        for (const SeamPoint& other : beyond) visit(other.point, Vec2(other.turn * flow));
    }
};

/// The coordinates of EOL vertex `entry` of the state, or the reason why it can have none. `positions` are
/// the cloth's in the obstacle's frame, whose placement is `end` when the step of `dt` (s) ends. `thickness`:
/// of the cloth, m.
struct EolPlacing {
    std::optional<EolCoordinates> coordinates;
    ConstraintCause refusal = ConstraintCause::NoDirection;  ///< without coordinates
};
EolPlacing place_eol_vertex(const Obstacle& obstacle, double thickness, const State& state, int entry,
                            const ClothStars& stars, const std::vector<Vec3>& positions, const Placement& end,
                            double dt = 0.0);

/// `place_eol_vertex` for obstacles at rest at the state's time; reads only the cloth around a vertex. Keeps
/// references: between calls the state's time and faces, and the stars, must not change.
class EolPlacer {
  public:
    EolPlacer(const std::vector<MovingObstacle>& obstacles, double thickness, const State& state,
              const ClothStars& stars)
        : obstacles_(obstacles), thickness_(thickness), state_(state), stars_(stars)
    {
    }

    EolPlacing place(int entry);

  private:
    const std::vector<MovingObstacle>& obstacles_;
    double thickness_;  ///< m
    const State& state_;
    const ClothStars& stars_;
    int of_ = -1;                  ///< index of the obstacle that `now_` is of
    ObstaclePose now_;             ///< that obstacle at the state's time
    std::vector<Vec3> positions_;  ///< in its frame; current only in the star of the last vertex placed
};

}  // namespace arris
