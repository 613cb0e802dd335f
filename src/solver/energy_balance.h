// SPDX-License-Identifier: GPL-3.0-or-later
// Energy balance of a step. The velocity solves equations that are linear around q^. Contact or a pin may
// stop cloth that q^ had extrapolated freely. Stiff cloth at q' then has a strain energy that the linear
// equations miss. The functions here detect such energy.
//
// The nonlinear equations themselves, with forces f of a potential V and forces R of pins and contacts, have
// for implicit Euler
//
//   M (v' - v_k) = h (f(q') + R),  q' - q_k = h v'
//   T' - T_k = (q' - q_k) . (f(q') + R) - 1/2 |v' - v_k|_M^2
//   V' - V_k <= -(q' - q_k) . f(q')                           V convex
//
// So in a step T + V rises by no more than the work of R and of forces without potential. R does work only as
// pins and obstacles move: a fixed pin does none, and a contact that closes takes energy. V of cloth is not
// convex under compression, and BDF2's energy is monotone only in a norm over two steps. But both integrators
// damp; the energy that remains is far below kRise.
//
// Where contact takes energy out, that sum hides excess strain, which throws the cloth in the next step.
// Stiff cloth that falls flat on an edge is stopped there. A cell of which one side goes on by d is then
// stretched by d^2 / 2. The linear equations miss energy the other way, too: where cloth slides over a round
// edge, each step loses what its cells turn by in it, first order in the step. `find_unforeseen_energy`
// detects both.
#pragma once

#include <vector>

#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/workspace.h"

namespace arris {

/// Energy of a cloth that has the workspace's faces. Faces at EOL vertices have the material of `cloth`.
ClothEnergy compute_cloth_energy(const Scene& scene, const Workspace& work, const MovingCloth& cloth);

/// Energy of the cloth in `state`: that of the last commit where the cloth is unchanged.
ClothEnergy find_energy(const Scene& scene, const State& state, const Workspace& work);

/// Work, J, that moving pins, moving obstacles, pulls and wind do on the cloth in the step from `state`.
/// Forces and motion follow from the velocity in `work.solution`. Negative where the cloth drives them.
double compute_driven_work(const State& state, const Workspace& work);

/// Sets `work.energies.start`, the energy at the step's start.
void measure_start_energy(const Scene& scene, const State& state, Workspace& work);

/// Sets `work.energies.solved` and `work.energies.proposed` for the proposal in `work`, after `dt` (s).
void measure_proposal_energy(const Scene& scene, double dt, Workspace& work);

/// Scale of a step's energies, J: kinetic energy at the start, plus the changes of each kind of energy in the
/// step. Tolerances on energy are shares of this scale. Call measure_proposal_energy first.
double energy_scale(const Workspace& work);

/// Rise, J, of the cloth's energy in the proposal beyond the work that drives the cloth, before cloth is
/// pushed out to its stand-off. 0 where the rise is within the tolerance of a step. Call
/// measure_proposal_energy first.
double find_energy_rise(const Scene& scene, const State& state, const Workspace& work);

/// Potential energy, J, that equations linear around `work.expansion` miss: the terms above second order in
/// the motion from there. An estimate, and 0 where it is below a share of `energy_scale`. If the cloth is
/// strained far more at `work.expansion`, that excess counts: history that ran into an obstacle strains the
/// cloth beside it. Call measure_proposal_energy first.
double find_unforeseen_energy(const Scene& scene, const State& state, const Workspace& work);

/// Whether pushing cloth out to its stand-off in `dt` (s) strains it. The push then costs more elastic energy
/// than the kinetic energy of its speed plus a share of the cloth's energy. Call measure_proposal_energy
/// first.
bool does_push_out_strain(const Scene& scene, double dt, const Workspace& work);

/// 1/2 |v - v~|_M^2 + V(q~ + gamma v), J: the step's objective without wind, pulls and damping.
double compute_step_objective(const Scene& scene, const Workspace& work, const ClothVelocity& velocity);

}  // namespace arris
