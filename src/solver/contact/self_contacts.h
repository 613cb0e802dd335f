// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/self_contact/self_contact.h"
#include "geometry/self_contact/self_surface.h"
#include "physics/cloth_elements.h"
#include "physics/linearization.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/pin_targets.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/time_integration.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A contact of the cloth with itself in one step: a row of the velocity solve. An EOL vertex enters by its
/// velocity in the world: the gap depends on where the surface is, not on the material there.
struct SelfRow {
    SelfContact contact;
    double last_multiplier = 0.0;        ///< N s, of the last step; 0 where it did not press
    ContactFriction last_friction = {};  ///< of the last step
    ContactFriction friction = {};       ///< of the last solve; before one, of the last step
    bool is_pressing = false;            ///< in the last solve of this step, at an earlier linearization
    bool is_closing = false;             ///< would be violated at the last velocity
    bool may_grow = true;                ///< whether its gap may grow to the thickness
    int row = -1;                        ///< of the velocity solve

    bool was_active() const { return last_multiplier > 0.0; }
};

/// Positions at which the cloth would end at its last velocity, with pinned vertices at their targets.
std::vector<Vec3> find_free_end(const State& state, const Prediction& prediction,
                                const std::vector<PinTarget>& held);

/// Contacts of the cloth with itself possible in the step. None without self-contact in the scene.
std::vector<SelfRow> find_self_rows(const Scene& scene, const State& state, const Prediction& prediction,
                                    const std::vector<PinTarget>& held, const SelfSurface& surface);

/// A contact that the check has found.
SelfRow make_self_row(const State& state, const SelfContact& contact);

/// 1 / mass of each vertex, 1/kg, with which contacts shift positions and history; 0 at pinned and EOL
/// vertices, which stay.
std::vector<double> find_mobility(double density, const ClothElements& elements,
                                  const std::vector<EolCoordinates>& eol, const std::vector<PinTarget>& held);

/// Flattens history as `flatten_history` does for contacts with obstacles: both sides keep their distance.
/// True where anything was flattened.
bool flatten_self_history(const State& state, const std::vector<Vec3>& free_end,
                          const std::vector<double>& mobility, std::size_t first,
                          const std::vector<SelfRow>& rows, Prediction& prediction);

/// Appends rows from `first` on to the problem, in the coordinates of `at`.
void append_self_rows(const State& state, const Prediction& prediction, const Linearization& at,
                      std::size_t first, std::vector<SelfRow>& rows, VelocityProblem& problem);

/// Moves positions out to the gaps that the rows keep, and up to `growth` (m) farther towards `thickness`.
void restore_self_stand_off(const std::vector<SelfRow>& rows, const std::vector<double>& mobility,
                            double thickness, double growth, std::vector<Vec3>& world);

/// Lets a row yield that could not be met together with the others: it keeps half of its gap. False where
/// nothing is left to yield.
bool yield_self_row(const State& state, double thickness, SelfRow& row);

/// Pressing contacts, for `State::self`.
std::vector<ActiveSelfContact> active_self_contacts(const State& state, const std::vector<SelfRow>& rows,
                                                    const VelocitySolution& solution);

}  // namespace arris
