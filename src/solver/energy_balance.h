// SPDX-License-Identifier: GPL-3.0-or-later
// A step's velocity solves equations that are linear around q^. Where contact or a pin stops what q^ had
// extrapolated freely, stiff cloth at q' has an energy that these equations know nothing of. Here is how that
// is seen.
//
// Implicit Euler at a solution of the equations themselves, f with potential V, R the forces of pins and
// contacts:
//
//   M (v' - v_k) = h (f(q') + R),  q' - q_k = h v'
//   T' - T_k = (q' - q_k) . (f(q') + R) - 1/2 |v' - v_k|_M^2
//   V' - V_k <= -(q' - q_k) . f(q')                           V convex
//
// so T + V rises by no more than the work of R, and of what has no potential, over the step, and of R only
// what moves with its own motion counts: a fixed pin does none, and a contact that closes takes some. Cloth's
// V is not convex under compression, and BDF2's energy is monotone only in a norm of two steps; but both
// damp, and what they leave is far below kRise.
//
// Where contact takes energy out, too much strain does not show in that sum, but throws the cloth in the next
// step: stiff cloth that falls flat on an edge is stopped beside it, and a cell across which it goes on by d
// is stretched by d^2 / 2. That is seen as what is unforeseen.
#pragma once

#include <vector>

#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/workspace.h"

namespace arris {

/// Of a cloth with the workspace's faces. Where material flows, elements are taken where it is.
ClothEnergy compute_cloth_energy(const Scene& scene, const Workspace& work, const MovingCloth& cloth);

/// Work, J, that moving pins, moving obstacles, pulls and wind do on the cloth in the step from `state` to
/// the velocity in `work.solution`, with the forces that this has found. Negative where they are driven.
double compute_driven_work(const State& state, const Workspace& work);

/// `work.energies.start` at the step's start, as the last step left it where that is known.
void measure_start_energy(const Scene& scene, const State& state, Workspace& work);

/// `work.energies.solved` and `work.energies.proposed` of a proposal after `dt` (s).
void measure_proposal_energy(const Scene& scene, double dt, Workspace& work);

/// J, of the cloth of a weighed proposal: what was in motion at the step's start, or changed kind in it.
double energy_scale(const Workspace& work);

/// By how much, J, the proposal in `work`, before anything was moved out to its stand-off, raises the cloth's
/// energy beyond the work that drives it, where that is more than a step may; else 0. Weigh it first.
double find_energy_rise(const Scene& scene, const State& state, const Workspace& work);

/// Elastic energy, J, that the proposal has gained and that equations linear around `work.expansion` do not
/// see, as it is of higher than second order in the way from there: about as much, where that is more than a
/// share of what was in motion or changed kind; else 0. All of the gain where the cloth is strained far more
/// there: flattened history beside what goes on strains it. Weigh it first.
double find_unforeseen_energy(const Scene& scene, const Workspace& work);

/// Whether moving the proposal's positions out to their stand-off in `dt` (s) has cost more elastic energy
/// than a push at that speed could give, and a share of what there is. Weigh it first.
bool does_push_out_strain(const Scene& scene, double dt, const Workspace& work);

/// 1/2 |v - v~|_M^2 + V(q~ + gamma v), J: what the step minimises, but for wind, pulls and damping.
double compute_step_objective(const Scene& scene, const Workspace& work, const ClothVelocity& velocity);

}  // namespace arris
