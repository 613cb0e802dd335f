// SPDX-License-Identifier: GPL-3.0-or-later
// A vertex on a sharp feature has three unknowns like any other: away from the feature (c), along it (a), and
// the material's flow over it (s); on a corner, or where a wire turns, c and two of flow. So contact is the
// bound c >= ..., and the system stays positive definite where the cloth is flat, where the world's and the
// material's motion across the feature are one and the same.
#pragma once

#include <optional>
#include <vector>

#include "geometry/obstacle/feature_frame.h"
#include "geometry/rigid_motion.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/row_cause.h"
#include "solver/model/state.h"

namespace arris {

/// One EOL vertex during a step: xdot = drift + basis u, Xdot = material_basis u, u = (c, a, s) or
/// (c, s1, s2).
struct EolCoordinates {
    int vertex;
    int entry;           ///< in State::eol
    FeatureFrame frame;  ///< at the step's start, in the obstacle's frame
    Vec3 carried;        ///< where riding on the obstacle takes it by the step's end, world
    Mat3 basis;          ///< first column: the outward direction at the step's end
    Mat23 material_basis;
    int side;      ///< EolVertex::side from now on
    Vec3 opening;  ///< change of u, (1, ...), that opens the gap with the least kinetic energy
};

/// The coordinates of EOL vertex `entry` of the state, or why it can have none. `positions` are the cloth's
/// in the obstacle's frame, which is at `end` when the step of `dt` (s) ends. `thickness`: of the cloth, m.
struct EolPlacing {
    std::optional<EolCoordinates> coordinates;
    RowCause refusal = RowCause::NoDirection;  ///< where there are none
};
EolPlacing place_eol_vertex(const Obstacle& obstacle, double thickness, const State& state, int entry,
                            const ClothStars& stars, const std::vector<Vec3>& positions, const Placement& end,
                            double dt = 0.0);

/// The same of obstacles that stay where they are at the state's time; looks at the cloth around a vertex
/// only. References are kept: between calls the state's time and faces, and the stars, may not change.
class EolPlacer {
  public:
    EolPlacer(const std::vector<Obstacle>& obstacles, double thickness, const State& state,
              const ClothStars& stars)
        : obstacles_(obstacles), thickness_(thickness), state_(state), stars_(stars)
    {
    }

    EolPlacing place(int entry);

  private:
    const std::vector<Obstacle>& obstacles_;
    double thickness_;  ///< m
    const State& state_;
    const ClothStars& stars_;
    int of_ = -1;                  ///< obstacle
    Placement now_;                ///< its
    std::vector<Vec3> positions_;  ///< in its frame, of the star that is looked at; the rest is old
};

}  // namespace arris
