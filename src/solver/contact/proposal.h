// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/contact/contacts.h"
#include "solver/model/pin_targets.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A step's end as it is proposed; not committed. One entry a vertex.
struct Proposal {
    std::vector<Vec3> world;              ///< q', m
    std::vector<Vec3> velocity;           ///< v', m/s
    std::vector<Vec2> material;           ///< X', m
    std::vector<Vec2> material_velocity;  ///< V', m/s
};

/// Moves positions, not velocities, out to what their contacts keep, which mends round-off, and of a cloth
/// nearer than its stand-off by up to `growth` (m) further. Pinned directions stay.
void restore_stand_off(const std::vector<Contact>& contacts, const std::vector<ObstacleStep>& steps,
                       const std::vector<PinTarget>& held, double thickness, double growth,
                       Proposal& proposal);

/// Violations of the proposed step by the exact check against every obstacle.
struct Violations {
    std::vector<Contact> contacts;
    std::vector<std::vector<int>> faces;  ///< of each obstacle: the cloth's faces that are not clean
    int crossings = 0;

    bool is_clean() const;
};

/// Checks the way from the state to the proposal; each step's `motion.end` becomes where the proposal is.
Violations check_proposal(const Scene& scene, const Proposal& proposal, const Prediction& prediction,
                          std::vector<ObstacleStep>& steps);

/// The last resort: patches of cloth that are not clean go back on their way, in the frame of the obstacle
/// they meet, to half of it, a quarter, ..., at last to where they were, riding on the obstacle; patches that
/// went all the way back grow by a ring of vertices. Velocity follows. Vertices that are pinned stay. Returns
/// how many vertices went back, or nothing where that did not make the step clean either.
std::optional<int> rewind(const Scene& scene, const State& state, const std::vector<PinTarget>& held,
                          const Prediction& prediction, double dt, std::vector<ObstacleStep>& steps,
                          Proposal& proposal);

}  // namespace arris
