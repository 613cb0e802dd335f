// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/self_contact/self_surface.h"
#include "solver/contact/contacts.h"
#include "solver/model/pin_targets.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// The proposed end of a step, not committed. One entry a vertex.
struct Proposal {
    std::vector<Vec3> world;              ///< q', m
    std::vector<Vec3> velocity;           ///< v', m/s
    std::vector<Vec2> material;           ///< X', m
    std::vector<Vec2> material_velocity;  ///< V', m/s
};

/// Moves positions out to the gaps that their contacts keep, which removes round-off. Cloth nearer than its
/// stand-off moves up to `growth` (m) farther. `mobility`: see find_mobility.
void restore_stand_off(const std::vector<Contact>& contacts, const Carriers& carriers,
                       const std::vector<double>& mobility, double growth, std::vector<Vec3>& world);

/// Violations of the proposed step by the exact check against every obstacle and of the cloth itself.
struct Violations {
    std::vector<Contact> contacts;
    std::vector<std::vector<int>> faces;  ///< for each obstacle: faces of the cloth that are not clean
    std::vector<int> self_faces;          ///< that met another part of the cloth
    int crossings = 0;

    bool is_clean() const;
};

/// Checks the motion from the state to the proposal; the `motion.end` of carriers is set to the proposal.
Violations check_proposal(const Scene& scene, const State& state, const SelfSurface& surface,
                          const Proposal& proposal, const Prediction& prediction, Carriers& carriers);

/// The last resort. Patches of cloth that are not clean go back on their path, in the frame of the obstacle
/// that they meet, or in the world where they meet the cloth: to half of it, a quarter, ..., at last to their
/// start, riding on the obstacle. Patches that went all the way back grow by one ring of vertices. Velocity
/// follows; pinned vertices stay. Returns the number of vertices that went back, or nothing where the step is
/// still not clean.
std::optional<int> rewind(const Scene& scene, const State& state, const SelfSurface& surface,
                          const std::vector<PinTarget>& held, const Prediction& prediction, double dt,
                          Carriers& carriers, Proposal& proposal);

}  // namespace arris
